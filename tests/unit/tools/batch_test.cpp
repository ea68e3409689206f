// What a batch is given and who works on it: flights in a folder, processes that may fail.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "tests/support/folder_test.h"
#include "tests/support/patience.h"
#include "tools/hovermodal/batch/inventory.h"
#include "tools/hovermodal/batch/workers.h"

namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class BatchInventory : public tests::FolderTest {
 protected:
  void put(const std::string& path) {
    fs::create_directories((folder_ / path).parent_path());
    std::ofstream(folder_ / path) << "x";
  }
  [[nodiscard]] tools::Inventory found(const std::string& results = "", const std::string& config = "") const {
    return tools::find_flights(folder_.string(), results, config);
  }
  [[nodiscard]] std::vector<std::string> names(const tools::Inventory& inventory) const {
    std::vector<std::string> out;
    for (const tools::Flight& flight : inventory.flights) out.push_back(flight.name + " " + to_string(flight.kind));
    return out;
  }
};

TEST_F(BatchInventory, FindsEveryKindByName) {
  for (const char* path : {"b_run0002_001.lcm", "b_run0002_000.lcm", "b_run0010_003.lcm", "south/made/tracks.csv",
                           "south/made/config.yaml", "north/hover.mp4", "north/hover.yaml", "telemetry.lcm"})
    put(path);
  const tools::Inventory inventory = found();
  EXPECT_THAT(names(inventory),
              ElementsAre("b_run0002 record", "b_run0010 record", "north/hover clip", "south/made tracks"));
  EXPECT_THAT(inventory.left_out, IsEmpty());
  EXPECT_THAT(inventory.flights[0].path, HasSubstr("b_run0002_000.lcm"));
  EXPECT_THAT(inventory.flights[1].path, HasSubstr("b_run0010_003.lcm"));  // its first files are missing
  EXPECT_THAT(inventory.flights[2].config, HasSubstr("hover.yaml"));
}

TEST_F(BatchInventory, WhatHasNoConfigurationIsLeftOutOrTakesTheGivenOne) {
  put("a/tracks.csv");
  put("b.mp4");
  EXPECT_THAT(found().flights, IsEmpty());
  EXPECT_THAT(found().left_out, ElementsAre(HasSubstr("a/tracks.csv: no configuration"),
                                            HasSubstr("b.mp4: no configuration: put b.yaml or config.yaml")));
  const tools::Inventory given = found("", "flight.yaml");
  EXPECT_THAT(names(given), ElementsAre("a tracks", "b clip"));
  EXPECT_EQ(given.flights[0].config, "flight.yaml");
}

TEST_F(BatchInventory, LinksToFoldersAreNamedAndNotFollowed) {
  put("a_run0001_000.lcm");
  fs::create_directory_symlink("..", folder_ / "up");
  fs::create_directory_symlink(".", folder_ / "here");
  EXPECT_THAT(names(found()), ElementsAre("a_run0001 record"));
  EXPECT_THAT(found().left_out,
              ElementsAre(HasSubstr("here: a link to a folder"), HasSubstr("up: a link to a folder")));
}

TEST_F(BatchInventory, EarlierReportsBesideAReportAreNoFlights) {
  for (const char* path : {"a/tracks.csv", "a/report.1/tracks.csv", "a/report.unfinished/tracks.csv"}) put(path);
  EXPECT_THAT(names(found("", "flight.yaml")), ElementsAre("a tracks"));
}

TEST_F(BatchInventory, ResultsAndClipsOfTracksAreNoFlights) {
  for (const char* path : {"a/tracks.csv", "a/clip.mp4", "a/config.yaml", "out/flights/a/tracks.csv"}) put(path);
  EXPECT_THAT(names(found((folder_ / "out").string(), "flight.yaml")), ElementsAre("a tracks"));
}

TEST_F(BatchInventory, NamesAreUnique) {
  for (const char* path : {"a.mp4", "a.mkv", "a.yaml", "a/tracks.csv", "a/config.yaml"}) put(path);
  EXPECT_THAT(names(found()), ElementsAre("a clip", "a_2 clip", "a_3 tracks"));
}

TEST_F(BatchInventory, NoFolderIsRefused) {
  EXPECT_THROW((void)tools::find_flights((folder_ / "none").string(), "", ""), std::invalid_argument);
}

// Programs in place of ours: scripts, which are given the arguments of a flight.
class BatchWorkers : public tests::FolderTest {
 protected:
  [[nodiscard]] std::string script(const std::string& name, const std::string& body) const {
    const fs::path path = folder_ / name;
    std::ofstream(path) << "#!/bin/sh\n" << body << "\n";
    fs::permissions(path, fs::perms::owner_all);
    return path.string();
  }
  [[nodiscard]] std::string failure_of(const std::string& program) const {
    tools::LocalWorkers workers(program, 1);
    tools::FlightOrder order;
    order.flight = {"a", tools::FlightKind::kTracks, "tracks.csv", "c.yaml"};
    order.into = (folder_ / "out").string();
    workers.start(7, order);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30) * tests::kSlowdown;
    while (std::chrono::steady_clock::now() < deadline) {
      if (const auto end = workers.poll()) {
        EXPECT_EQ(end->number, 7U);
        EXPECT_TRUE(workers.has_room());
        return end->failure;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return "would not end";
  }
};

TEST_F(BatchWorkers, AFlightThatLeavesItsSumsIsDone) {
  EXPECT_EQ(failure_of(script("good", "while [ \"$1\" != --into ]; do shift; done; touch \"$2/flight.sums\"")), "");
}

TEST_F(BatchWorkers, ACrashIsThatFlightsFailure) {
  EXPECT_THAT(failure_of(script("crash", "kill -SEGV $$")), HasSubstr("signal 11"));
}

TEST_F(BatchWorkers, AFailureIsToldInItsOwnWords) {
  EXPECT_EQ(failure_of(script("bad", "echo working; echo 'hovermodal: a.csv:3: is no number' >&2; exit 1")),
            "a.csv:3: is no number");
  EXPECT_EQ(failure_of(script("mute", "exit 3")), "its process ended with exit code 3");
  EXPECT_EQ(failure_of(script("idle", "exit 0")), "its process ended without a result");
}

TEST_F(BatchWorkers, AProgramThatIsNotThereIsAFailure) {
  EXPECT_THAT(failure_of((folder_ / "none").string()), HasSubstr("cannot be started"));
}

TEST_F(BatchWorkers, AnEarlierResultIsNotTakenForThisOne) {
  fs::create_directories(folder_ / "out");
  std::ofstream(folder_ / "out" / "flight.sums") << "old";
  EXPECT_EQ(failure_of(script("idle", "exit 0")), "its process ended without a result");
}

}  // namespace
