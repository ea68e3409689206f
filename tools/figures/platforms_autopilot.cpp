// An autopilot made of MAVLink's own C library (https://github.com/mavlink/c_library_v2), for figure 4 of platforms.sh,
// which compiles it beside the project. What it was and sent is its standard output.
//   platforms_autopilot stream PORT SEED PACKETS NOISE_BYTES   one TCP client is sent packets of many kinds between
//   noise platforms_autopilot clock PORT SEED SECONDS DELAY_MS JITTER_MS   UDP: answers TIMESYNC late, its clock drifts
//   platforms_autopilot motors PORT SEED SECONDS HZ SPREAD_HZ   UDP: four motors, of which the third turns at HZ
#include <ardupilotmega/mavlink.h>
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <queue>
#include <random>
#include <string>
#include <vector>

namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr double kAhead_ns = 1234.5e9, kDrift = 30e-6;

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

std::int64_t remote_ns() {
  const auto local = static_cast<double>(now_ns());
  return static_cast<std::int64_t>(local * (1.0 + kDrift) + kAhead_ns);
}

Bytes bytes_of(const mavlink_message_t& message) {
  Bytes out(MAVLINK_MAX_PACKET_LEN);
  out.resize(mavlink_msg_to_send_buffer(out.data(), &message));
  return out;
}

sockaddr_in loopback(int port) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_port = htons(static_cast<std::uint16_t>(port));
  out.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return out;
}

mavlink_message_t drawn_message(std::mt19937& engine) {
  mavlink_message_t m{};
  std::uniform_real_distribution<float> angle(-1.5F, 1.5F);
  const auto ms = static_cast<std::uint32_t>(engine());
  const auto number = [&] { return static_cast<std::int32_t>(engine()); };
  switch (engine() % 10) {
    case 0:
      mavlink_msg_attitude_pack(1, 1, &m, ms, angle(engine), angle(engine), angle(engine), 0, 0, 0);
      break;
    case 1: {
      const float offset[4] = {1, 0, 0, 0};
      mavlink_msg_attitude_quaternion_pack(1, 1, &m, ms, 1, 0, 0, 0, angle(engine), 0, 0, offset);
      break;
    }
    case 2:
      mavlink_msg_global_position_int_pack(1, 1, &m, ms, number(), number(), number(), number(), 1, 2, 3, 4);
      break;
    case 3:
      mavlink_msg_wind_pack(1, 1, &m, 10.0F * angle(engine), angle(engine), 0);
      break;
    case 4: {
      const std::int32_t rpm[4] = {number(), number(), 0, 0};
      const float zero[4] = {};
      mavlink_msg_esc_status_pack(1, 1, &m, 0, ms, rpm, zero, zero);
      break;
    }
    case 5:
      mavlink_msg_statustext_pack(1, 1, &m, 6, "the quick brown fox", 0, 0);
      break;
    case 6:
      mavlink_msg_param_value_pack(1, 1, &m, "PARAMETER", angle(engine), 9, 100, static_cast<std::uint16_t>(engine()));
      break;
    case 7:
      mavlink_msg_heartbeat_pack(1, 1, &m, MAV_TYPE_QUADROTOR, MAV_AUTOPILOT_ARDUPILOTMEGA, 81, ms, MAV_STATE_ACTIVE);
      break;
    case 8:
      mavlink_msg_raw_imu_pack(1, 1, &m, ms, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 0);
      break;
    default: {
      std::uint8_t data[128];
      for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(engine());
      mavlink_msg_serial_control_pack(1, 1, &m, 1, 2, 3, 4, 70, data, 0, 0);
    }
  }
  return m;
}

int stream(int port, std::uint32_t seed, long packets, long noise) {
  std::mt19937 engine(seed);
  Bytes all;
  long noise_left = noise;
  for (long i = 0; i < packets; ++i) {
    for (long k = static_cast<long>(engine() % static_cast<std::uint32_t>(2 * noise / packets + 1));
         k > 0 && noise_left > 0; --k, --noise_left)
      all.push_back(engine() % 16 == 0 ? 0xFD : static_cast<std::uint8_t>(engine()));
    const Bytes one = bytes_of(drawn_message(engine));
    all.insert(all.end(), one.begin(), one.end());
  }
  for (; noise_left > 0; --noise_left) all.push_back(static_cast<std::uint8_t>(engine()));
  all.insert(all.end(), 300, 0);
  const int listener = socket(AF_INET, SOCK_STREAM, 0), yes = 1;
  setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const sockaddr_in here = loopback(port);
  if (bind(listener, reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0 || listen(listener, 1) != 0) return 1;
  const int client = accept(listener, nullptr, nullptr);
  std::size_t done = 0;
  Bytes unread(65536);
  while (done < all.size()) {
    while (recv(client, unread.data(), unread.size(), MSG_DONTWAIT) > 0) {
    }
    const std::size_t part = std::min<std::size_t>(all.size() - done, 1 + engine() % 3000);
    const ssize_t n = send(client, all.data() + done, part, MSG_NOSIGNAL);
    if (n <= 0) return 1;
    done += static_cast<std::size_t>(n);
  }
  std::printf("%ld %ld\n", packets, noise);
  std::fflush(stdout);
  sleep(3);  // the client reads to its end
  return 0;
}

struct Late {
  std::int64_t at_ns;
  Bytes bytes;
  bool leaves;  // else it has come in
  bool operator<(const Late& other) const { return at_ns > other.at_ns; }
};

int clock_link(int port, std::uint32_t seed, double seconds, double delay_ms, double jitter_ms) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> jitter(0.0, jitter_ms);
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  const sockaddr_in there = loopback(port);
  if (connect(fd, reinterpret_cast<const sockaddr*>(&there), sizeof there) != 0) return 1;
  std::priority_queue<Late> late;
  const auto after = [&] { return now_ns() + static_cast<std::int64_t>(1e6 * (delay_ms + jitter(engine))); };
  const std::int64_t start = now_ns();
  std::int64_t next_beat = start, next_attitude = start;
  while (static_cast<double>(now_ns() - start) < 1e9 * seconds) {
    pollfd one{fd, POLLIN, 0};
    poll(&one, 1, 1);
    Bytes bytes(2048);
    for (ssize_t n = 0; (n = recv(fd, bytes.data(), bytes.size(), MSG_DONTWAIT)) > 0;)
      late.push({after(), Bytes(bytes.begin(), bytes.begin() + n), false});
    mavlink_message_t m{};
    if (now_ns() >= next_beat) {
      mavlink_msg_heartbeat_pack(1, 1, &m, MAV_TYPE_QUADROTOR, MAV_AUTOPILOT_PX4, 81, 0, MAV_STATE_ACTIVE);
      late.push({after(), bytes_of(m), true});
      next_beat += 1'000'000'000;
    }
    if (now_ns() >= next_attitude) {
      mavlink_msg_attitude_pack(1, 1, &m, static_cast<std::uint32_t>(remote_ns() / 1'000'000), 0.01F, 0.02F, 0.03F, 0,
                                0, 0);
      late.push({after(), bytes_of(m), true});
      next_attitude += 20'000'000;
    }
    while (!late.empty() && late.top().at_ns <= now_ns()) {
      const Late now = late.top();
      late.pop();
      if (now.leaves) {
        (void)!send(fd, now.bytes.data(), now.bytes.size(), 0);
        continue;
      }
      mavlink_status_t status{};
      for (const std::uint8_t byte : now.bytes) {
        mavlink_message_t got{};
        if (mavlink_parse_char(MAVLINK_COMM_0, byte, &got, &status) == 0 || got.msgid != MAVLINK_MSG_ID_TIMESYNC)
          continue;
        if (mavlink_msg_timesync_get_tc1(&got) != 0) continue;
        mavlink_msg_timesync_pack(1, 1, &m, remote_ns(), mavlink_msg_timesync_get_ts1(&got), 0, 0);
        late.push({after(), bytes_of(m), true});
      }
    }
  }
  std::printf("%.0f %.9f\n", kAhead_ns, kDrift);
  return 0;
}

// Motor speeds ten times a second, about the given rate of the third motor; the others turn 2 to 9 Hz faster or slower.
int motors(int port, std::uint32_t seed, double seconds, double hz, double spread_hz) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> apart(2.0, 9.0);
  std::normal_distribution<double> varies(0.0, spread_hz);
  double mean_hz[4];
  for (double& mean : mean_hz) mean = hz + (engine() % 2 == 0 ? 1.0 : -1.0) * apart(engine);
  mean_hz[2] = hz;
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  const sockaddr_in there = loopback(port);
  if (connect(fd, reinterpret_cast<const sockaddr*>(&there), sizeof there) != 0) return 1;
  const std::int64_t start = now_ns();
  for (int i = 0; static_cast<double>(now_ns() - start) < 1e9 * seconds; ++i) {
    mavlink_message_t m{};
    if (i % 10 == 0) {
      mavlink_msg_heartbeat_pack(1, 1, &m, MAV_TYPE_QUADROTOR, MAV_AUTOPILOT_PX4, 81, 0, MAV_STATE_ACTIVE);
      const Bytes beat = bytes_of(m);
      (void)!send(fd, beat.data(), beat.size(), 0);
    }
    std::int32_t rpm[4];
    for (int k = 0; k < 4; ++k) rpm[k] = static_cast<std::int32_t>(60.0 * (mean_hz[k] + varies(engine)));
    const float none[4] = {};
    mavlink_msg_esc_status_pack(1, 1, &m, 0, static_cast<std::uint64_t>(remote_ns() / 1000), rpm, none, none);
    const Bytes speeds = bytes_of(m);
    (void)!send(fd, speeds.data(), speeds.size(), 0);
    usleep(100'000);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const auto number = [&](int i) { return argc > i ? std::strtod(argv[i], nullptr) : 0.0; };
  const std::string what = argc > 1 ? argv[1] : "";
  const auto port = static_cast<int>(number(2));
  const auto seed = static_cast<std::uint32_t>(number(3));
  if (what == "stream" && argc == 6)
    return stream(port, seed, static_cast<long>(number(4)), static_cast<long>(number(5)));
  if (what == "clock" && argc == 7) return clock_link(port, seed, number(4), number(5), number(6));
  if (what == "motors" && argc == 7) return motors(port, seed, number(4), number(5), number(6));
  std::fprintf(stderr, "usage: see the head of tools/figures/platforms_autopilot.cpp\n");
  return 2;
}
