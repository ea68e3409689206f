#ifdef HOVERMODAL_WITH_LCM
#include "drivers/telemetry/event_log_reader.h"

#include <gtest/gtest.h>

#include "drivers/storage/text_file.h"
#include "drivers/telemetry/event_log.h"
#include "tests/support/test_clip.h"

namespace {

using drivers::EventLogReader;
namespace fs = std::filesystem;

std::vector<std::uint8_t> payload(std::size_t n) {
  std::vector<std::uint8_t> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<std::uint8_t>(i % 251);
  return out;
}

// In the format of LCM's own writer.
std::string log_of(const fs::path& path, std::initializer_list<std::size_t> sizes) {
  {
    drivers::EventLogFile log(path.string());
    std::int64_t k = 0;
    for (const std::size_t n : sizes) EXPECT_TRUE(log.write("C" + std::to_string(n), payload(n), 1'000'000 * ++k));
  }
  return test_support::read_bytes(path);
}

std::string head(std::uint32_t n_channel, std::uint32_t n_data) {
  std::string out("\xED\xA1\xDA\x01", 4);
  out.append(16, '\0');
  for (const std::uint32_t value : {n_channel, n_data}) {
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xFFU);
  }
  return out;
}

struct Read {
  std::vector<std::size_t> sizes;
  std::uint64_t n_damaged = 0;
};
Read read(const fs::path& path, const std::string& bytes) {
  test_support::write_text(path, bytes);
  EventLogReader reader(path.string());
  EventLogReader::Event event;
  Read out;
  while (reader.next(event)) {
    EXPECT_EQ(event.data, payload(event.data.size()));
    EXPECT_EQ(event.channel, "C" + std::to_string(event.data.size()));
    out.sizes.push_back(event.data.size());
  }
  out.n_damaged = reader.n_damaged();
  return out;
}

// Two gigabytes stated in a sparse file of that size: nothing of it is taken into memory.
TEST(EventLogReader, ALengthBeyondTheBoundIsDamage) {
  const fs::path path = test_support::fresh_folder() / "sparse.lcm";
  test_support::write_text(path, head(1, 0x7FFFFFF0U) + "C");
  fs::resize_file(path, 100'000'000);
  EventLogReader reader(path.string());
  EventLogReader::Event event;
  EXPECT_FALSE(reader.next(event));
  EXPECT_EQ(reader.n_damaged(), 1U);
  EXPECT_LT(event.data.capacity(), 1U << 20U);
}

TEST(EventLogReader, ReadsWhatLcmWrites) {
  const fs::path path = test_support::fresh_folder() / "run.lcm";
  log_of(path, {0, 1, 70'000, 5});
  EventLogReader reader(path.string());
  EventLogReader::Event event;
  std::int64_t k = 0;
  for (const std::size_t n : {0U, 1U, 70'000U, 5U}) {
    ASSERT_TRUE(reader.next(event));
    EXPECT_EQ(event.channel, "C" + std::to_string(n));
    EXPECT_EQ(event.data, payload(n));
    EXPECT_EQ(event.utc_us, 1000 * ++k);
  }
  EXPECT_FALSE(reader.next(event));
  EXPECT_EQ(reader.n_damaged(), 0U);
}

// Each terminates a program that reads it through liblcm 1.3.1, or makes it allocate gigabytes.
TEST(EventLogReader, LengthsThatCannotBeAreCountedAndTheNextEventIsFound) {
  const fs::path path = test_support::fresh_folder() / "run.lcm";
  const std::string good = log_of(path, {3, 4});
  for (const auto& [n_channel, n_data] :
       std::initializer_list<std::pair<std::uint32_t, std::uint32_t>>{{0, 4},
                                                                      {1000, 4},
                                                                      {0xFFFFFFFFU, 4},
                                                                      {0x80000000U, 4},
                                                                      {2, 0xFFFFFFFFU},
                                                                      {2, 0x80000000U},
                                                                      {2, 0x7FFFFFFFU}}) {
    const Read out = read(path, head(n_channel, n_data) + good);
    EXPECT_EQ(out.sizes, (std::vector<std::size_t>{3, 4})) << n_channel << " " << n_data;
    EXPECT_EQ(out.n_damaged, 1U);
  }
  EXPECT_TRUE(read(path, head(2, 60'000'000) + good).sizes.empty());  // longer than the file: the end
  const Read within = read(path, head(2, 10) + good + good);          // ends in the midst of an event
  EXPECT_EQ(within.n_damaged, 1U);
  EXPECT_EQ(within.sizes, (std::vector<std::size_t>{4, 3, 4}));
}

TEST(EventLogReader, AnEventThatTheEndCutsOffIsNone) {
  const fs::path path = test_support::fresh_folder() / "run.lcm";
  const std::string good = log_of(path, {3, 40});
  for (std::size_t n = 0; n < good.size(); ++n) EXPECT_LE(read(path, good.substr(0, n)).sizes.size(), 1U) << n;
  EXPECT_EQ(read(path, good).sizes.size(), 2U);
}

TEST(EventLogReader, RefusesWhatIsNoFile) {
  EXPECT_THROW(EventLogReader("no_such_file.lcm"), drivers::FileError);
  EXPECT_THROW(EventLogReader(test_support::fresh_folder().string()), drivers::FileError);
}

}  // namespace
#endif
