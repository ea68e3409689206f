// Writes the seeds of every fuzz target: small inputs that are valid, or invalid in one way.
//   make_corpus tests/fuzz/corpus
#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "core/spectrum/time_grid.h"
#include "drivers/mavlink/mavlink_frame.h"
#include "drivers/mavlink/mavlink_layouts.h"
#include "drivers/storage/checkpoint_file.h"
#include "drivers/storage/text_file.h"
#include "drivers/telemetry/encode_run.h"
#include "drivers/telemetry/event_log.h"
#include "firmware_app/chain/state/keyframe_jpeg.h"
#include "tests/fuzz/make_corpus.h"
#include "tests/fuzz/small_state.h"
#include "tests/support/hostile_messages.h"

namespace tests::fuzz {
namespace {

std::filesystem::path corpus;

}  // namespace

void keep(const std::string& target, const std::string& name, const std::vector<std::uint8_t>& bytes) {
  std::filesystem::create_directories(corpus / target);
  std::ofstream(corpus / target / name, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

void keep(const std::string& target, const std::string& name, const std::string& text) {
  keep(target, name, std::vector<std::uint8_t>(text.begin(), text.end()));
}

}  // namespace tests::fuzz

namespace {

namespace fs = std::filesystem;
using tests::Bytes;
using tests::fuzz::keep;

void append(Bytes& out, const Bytes& bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); }
void put_number(Bytes& out, std::size_t value, int n_bytes) {
  for (int shift = 8 * (n_bytes - 1); shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}
Bytes piece(std::uint8_t kind, const Bytes& bytes) {
  Bytes out{kind};
  put_number(out, bytes.size(), 2);
  append(out, bytes);
  return out;
}

// A heartbeat, an attitude and an answer about the time, in one stream, and each cut short.
void write_mavlink_frames() {
  Bytes all;
  for (const std::uint32_t id :
       {drivers::MavlinkFields::Heartbeat::kId, drivers::MavlinkFields::AttitudeQuaternion::kId,
        drivers::MavlinkFields::Timesync::kId, drivers::MavlinkFields::EscStatus::kId}) {
    drivers::MavlinkFrame frame{.id = id, .system = 1, .component = 1};
    for (std::size_t i = 0; i < 40; ++i) frame.payload[i] = static_cast<std::uint8_t>(i % 4 == 3 ? 0x3F : i);
    std::array<std::uint8_t, drivers::kMavlinkMostBytes> out{};
    const std::size_t n = drivers::write_mavlink(frame, out);
    const Bytes one(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(n));
    keep("mavlink", "kind_" + std::to_string(id), one);
    keep("mavlink", "cut_" + std::to_string(id), Bytes(one.begin(), one.end() - 1));
    append(all, one);
  }
  keep("mavlink", "stream", all);
}

void write_lcm() {
  tests::HostileMessages messages(1, "F", "F_ATTITUDE");
  Bytes all;
  for (std::size_t i = 0; i < messages.good().size(); ++i) {
    const Bytes one = piece(static_cast<std::uint8_t>(i), messages.good()[i].second);
    keep("lcm", "kind_" + std::to_string(i), one);
    append(all, one);
  }
  keep("lcm", "all", all);
  keep("lcm", "hostile_lengths", piece(0x80, Bytes(64, 0x7F)));
}

Bytes fragment(std::size_t number, std::size_t size, std::size_t offset, std::size_t index, std::size_t count,
               const Bytes& data) {
  Bytes out{'L', 'C', '0', '3'};
  put_number(out, number, 4), put_number(out, size, 4), put_number(out, offset, 4);
  put_number(out, index, 2), put_number(out, count, 2);
  append(out, data);
  return out;
}

void write_datagrams() {
  Bytes whole{'L', 'C', '0', '2', 0, 0, 0, 1, 'F', '_', 'M', 0, 1, 2, 3};
  keep("datagrams", "short", piece(0, whole));
  const Bytes first{'F', '_', 'M', 0, 'a', 'b'}, second{'c', 'd'};
  Bytes in_order = piece(0, fragment(5, 4, 0, 0, 2, first)), turned = piece(1, fragment(5, 4, 2, 1, 2, second));
  append(in_order, piece(0, fragment(5, 4, 2, 1, 2, second)));
  append(turned, piece(0, fragment(5, 4, 2, 1, 2, second)));
  append(turned, piece(1, fragment(5, 4, 0, 0, 2, first)));
  keep("datagrams", "two_fragments", in_order);
  keep("datagrams", "two_senders", turned);
  keep("datagrams", "impossible_offset", piece(0, fragment(6, 4, 0xFFFFFFFFU, 0, 2, first)));
  keep("datagrams", "impossible_size", piece(0, fragment(6, 0xFFFFFFFFU, 0, 0, 2, first)));
}

template <class Save>
Bytes state_of(std::size_t n_bytes, const Save& save) {
  Bytes bytes(n_bytes);
  core::StateWriter out(bytes);
  save(out);
  bytes.resize(out.n_used());
  return bytes;
}
Bytes behind(char what, const Bytes& bytes) {
  Bytes out{static_cast<std::uint8_t>(what)};
  append(out, bytes);
  return out;
}

void write_checkpoint() {
  core::TimeGrid grid(tests::fuzz::kRate_hz);
  core::WelchCpsd welch(tests::fuzz::small_welch());
  constexpr std::array<std::uint8_t, tests::fuzz::kChannels> kSeen{1, 1};
  for (int k = 0; k < 23; ++k) {
    static_cast<void>(grid.place(k * 40'000'000));
    static_cast<void>(welch.push(std::array<double, tests::fuzz::kChannels>{1.0 * (k % 5), 0.5 * (k % 3)}, kSeen));
  }
  core::ModeTracker tracker = tests::fuzz::small_tracker();
  for (int k = 0; k < 3; ++k) {
    core::ModalEstimate estimate = tests::fuzz::small_estimate(k);
    tracker.update(estimate);
  }
  const Bytes spectrum = state_of(welch.state_bytes() + 64, [&](auto& out) { grid.save(out), welch.save(out); });
  const Bytes modes = state_of(tracker.state_bytes(), [&](auto& out) { tracker.save(out); });
  const Bytes state = app::to_bytes(tests::fuzz::small_state(spectrum, modes));
  keep("checkpoint", "spectrum", behind('s', spectrum));
  keep("checkpoint", "modes", behind('m', modes));
  keep("checkpoint", "state", behind('b', state));
  const fs::path file = fs::temp_directory_path() / "hovermodal_make_corpus.state";
  if (!drivers::write_checkpoint(file.string(), state).empty()) throw std::runtime_error("no room in TMPDIR");
  const std::string kept = [&] {
    std::ifstream in(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }();
  fs::remove(file);
  keep("checkpoint", "file", "f" + kept);
  keep("checkpoint", "file_cut_off", "f" + kept.substr(0, 100));
  Bytes keyframe;
  const auto put = [&](const auto& value) {
    const auto* at = reinterpret_cast<const std::uint8_t*>(&value);
    keyframe.insert(keyframe.end(), at, at + sizeof value);
  };
  core::TrackPoint base{1.0, 2.0, 0.05, 0, 0, true, true}, roof{3.0, 4.0, 0.05, 1, 1, true, true};
  put(tests::fuzz::kConfigHash), put(std::uint64_t{0}), put(std::int64_t{0}), put(8), put(6), put(std::uint64_t{48});
  keyframe.resize(keyframe.size() + 48, 128);
  put(std::uint64_t{2}), put(base), put(roof);
  keep("checkpoint", "keyframe", behind('k', keyframe));
}

void write_http() {
  const std::string host = " HTTP/1.1\r\nHost: 127.0.0.1\r\n";
  const std::string token = "0123456789abcdef0123456789abcdef";
  keep("http", "page", "0GET /" + host + "\r\n");
  keep("http", "head", "0HEAD /snapshot.json?a=1&b=%20" + host + "Range: bytes=0-1,2-\r\n\r\n");
  keep("http", "token", "1GET /?token=" + token + host + "Sec-Fetch-Site: none\r\n\r\n");
  keep("http", "cookie",
       "1GET /" + host + "Cookie: a=b; hovermodal_token=" + token + "\r\nOrigin: http://127.0.0.1\r\n\r\n");
  keep("http", "no_token", "1GET /snapshot.json" + host + "\r\n");
  keep("http", "post", "2POST /change" + host + "Content-Type: application/json\r\nContent-Length: 4\r\n\r\n[12]");
  const std::string saved =
      R"({"regions": [{"name": "roof", "rect": [1, 2, 30, 40], "role": "base", "axis": "-12.5"}]})";
  keep("http", "regions",
       "2POST /regions" + host + "Content-Length: " + std::to_string(saved.size()) + "\r\n\r\n" + saved);
  keep("http", "form",
       "2POST /change" + host +
           "Content-Type: multipart/form-data; boundary=x\r\nContent-Length: 70\r\n\r\n--x\r\nContent-Disposition: "
           "form-data; name=\"a\"\r\n\r\n1\r\n--x--\r\n      ");
  keep("http", "events", "0GET /events" + host + "\r\n");
  keep("http", "two_lengths", "2POST /change" + host + "Content-Length: 1\r\nContent-Length: 2\r\n\r\nab");
  keep("http", "chunked", "2POST /change" + host + "Transfer-Encoding: chunked\r\n\r\n1\r\na\r\n0\r\n\r\n");
  keep("http", "socket_page", "4GET /" + host + "\r\n");
  keep("http", "socket_events", "4GET /events" + host + "\r\n");
  keep("http", "up", "0GET /%2e%2e/%2e%2e/etc/passwd" + host + "\r\n");
}

core::RunHead small_head() {
  core::RunHead head;
  head.config_yaml =
      "camera: {source: a.mp4}\nregions:\n  - {name: base, rect: [0, 0, 30, 30], role: base}\n"
      "  - {name: roof, rect: [0, 40, 30, 30]}\nspectrum: {segment: 16}\ntelemetry: {lcm_url: ''}\n";
  head.camera = {100, 80, 25.0, 10'000'000, core::ReadoutDirection::kDown, 0, 0, true, "made up"};
  for (std::uint32_t i = 0; i < 8; ++i) {
    head.keyframe.points.push_back(
        {5.0 + 3.0 * (i % 4), i < 4 ? 10.0 : 50.0, 0.05, i, static_cast<std::uint16_t>(i / 4), true, true});
  }
  return head;
}

void write_record(const core::RunHead& head, const std::string& name, const std::string& health_state) {
  const fs::path path = fs::temp_directory_path() / "hovermodal_make_corpus.lcm";
  {
    drivers::EventLogFile log(path.string());
    const auto write = [&](const char* suffix, const auto& message) {
      if (!log.write(std::string("F") + suffix, tests::encoded_bytes(message), 1'000'000))
        throw std::runtime_error("no room in TMPDIR");
    };
    for (const auto& file : head.files) {
      for (const auto& part : drivers::to_messages(file)) write(drivers::kRunFileSuffix, part);
    }
    write(drivers::kRunSuffix, drivers::to_message(head, {"F", 1}));
    core::TrackFrame tracks = head.keyframe;
    core::AttitudeBatch attitude;
    attitude.add({0.01, {1.0, 0.0, 0.0, 0.0}});
    for (int k = 0; k < 24; ++k) {
      tracks.sequence = static_cast<std::uint64_t>(k), tracks.t_start_ns = 40'000'000 * k;
      for (auto& point : tracks.points) point.u_px += (k % 4 < 2 ? 0.3 : -0.3) * (point.region == 1 ? 1.0 : 0.1);
      write(drivers::kRunFrameSuffix, drivers::to_message(tracks, attitude));
    }
    write(drivers::kTopicSuffixes[drivers::kHealth],
          drivers::to_message(tests::sample_health(health_state, 2), tests::sample_channels(2), {"F", 1}));
  }
  std::ifstream in(path, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  for (const char* target : {"record", "replay"}) {
    keep(target, name, bytes);
    if (name == "run") keep(target, "cut_off", bytes.substr(0, 2000));
  }
  fs::remove(path);
}

void write_records() {
  core::RunHead head = small_head();
  write_record(head, "run", "finished");
  head.files.push_back({"calibration.file", "camera.yaml",
                        "height: 80\nwidth: 100\ndistortion_model: plumb_bob\nD: [-0.1, 0.01, 0, 0, 0]\n"
                        "K: [90, 0, 50, 0, 90, 40, 0, 0, 1]\n"});
  core::Frame image;
  image.width_px = head.camera.width_px, image.height_px = head.camera.height_px;
  for (int i = 0; i < image.width_px * image.height_px; ++i) image.pixels.push_back(static_cast<std::uint8_t>(i / 100));
  head.files.push_back({"keyframe", "keyframe.jpg", app::keyframe_jpeg(image)});
  write_record(head, "with_files", "fault: no camera");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage, from the top of the sources: make_corpus tests/fuzz/corpus\n";
    return 2;
  }
  try {
    tests::fuzz::corpus = argv[1];
    tests::fuzz::write_texts();
    tests::fuzz::write_exchange();
    tests::fuzz::write_programs();
    write_lcm();
    write_mavlink_frames();
    write_datagrams();
    write_checkpoint();
    write_http();
    write_records();
  } catch (const std::exception& error) {
    std::cerr << "make_corpus: " << error.what() << "\n";
    return 1;
  }
}
