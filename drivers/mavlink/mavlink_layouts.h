#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace drivers {

// Written by tools/mavlink_layouts.py from MAVLink's message definitions, commit
// de1e078a3a7c53c9262a95b7417959a0f8bf4150 2026-07-22 (minimal, standard, common, ardupilotmega).

struct MavlinkLayout {
  std::uint32_t id = 0;
  std::uint8_t crc_extra = 0;  // completes the checksum
  std::uint8_t size = 0;       // of the payload with all extensions, bytes
};

// All messages, by id: with them a frame of any kind is distinguished from noise.
inline constexpr std::array<MavlinkLayout, 307> kMavlinkLayouts{{
    {0, 50, 9},       {1, 124, 43},     {2, 137, 12},     {4, 237, 14},     {5, 217, 28},      {6, 104, 3},
    {7, 119, 32},     {8, 117, 36},     {11, 89, 6},      {20, 214, 20},    {21, 159, 2},      {22, 220, 25},
    {23, 168, 23},    {24, 24, 52},     {25, 23, 101},    {26, 170, 24},    {27, 144, 29},     {28, 67, 16},
    {29, 115, 16},    {30, 39, 28},     {31, 246, 48},    {32, 185, 28},    {33, 104, 28},     {34, 237, 22},
    {35, 244, 22},    {36, 222, 37},    {37, 212, 7},     {38, 9, 7},       {39, 254, 38},     {40, 230, 5},
    {41, 28, 4},      {42, 28, 18},     {43, 132, 3},     {44, 221, 9},     {45, 232, 3},      {46, 11, 2},
    {47, 153, 8},     {48, 41, 21},     {49, 39, 20},     {50, 78, 37},     {51, 196, 5},      {54, 15, 27},
    {55, 3, 25},      {61, 167, 72},    {62, 183, 26},    {63, 119, 181},   {64, 191, 225},    {65, 118, 42},
    {66, 148, 6},     {67, 21, 4},      {69, 243, 30},    {70, 124, 38},    {73, 38, 38},      {74, 20, 20},
    {75, 158, 35},    {76, 152, 33},    {77, 143, 10},    {80, 14, 4},      {81, 106, 22},     {82, 49, 51},
    {83, 22, 37},     {84, 143, 53},    {85, 140, 51},    {86, 5, 53},      {87, 150, 51},     {89, 231, 28},
    {90, 183, 56},    {91, 63, 42},     {92, 54, 33},     {93, 47, 81},     {100, 175, 34},    {101, 102, 117},
    {102, 158, 117},  {103, 208, 57},   {104, 56, 116},   {105, 93, 63},    {106, 138, 44},    {107, 108, 65},
    {108, 32, 92},    {109, 185, 9},    {110, 84, 254},   {111, 34, 18},    {112, 174, 12},    {113, 124, 39},
    {114, 237, 44},   {115, 4, 64},     {116, 76, 24},    {117, 128, 6},    {118, 56, 14},     {119, 116, 12},
    {120, 134, 97},   {121, 237, 2},    {122, 203, 2},    {123, 250, 113},  {124, 87, 57},     {125, 203, 6},
    {126, 220, 81},   {127, 25, 35},    {128, 226, 35},   {129, 46, 24},    {130, 29, 13},     {131, 223, 255},
    {132, 85, 39},    {133, 6, 18},     {134, 229, 43},   {135, 203, 8},    {136, 1, 22},      {137, 195, 16},
    {138, 109, 120},  {139, 168, 43},   {140, 181, 41},   {141, 47, 32},    {142, 72, 243},    {143, 131, 16},
    {144, 127, 93},   {146, 103, 100},  {147, 154, 54},   {148, 178, 78},   {149, 200, 60},    {150, 134, 42},
    {151, 219, 8},    {152, 208, 8},    {153, 188, 12},   {154, 84, 15},    {155, 22, 13},     {156, 19, 6},
    {157, 21, 15},    {158, 134, 15},   {160, 78, 12},    {161, 68, 3},     {162, 189, 9},     {163, 127, 28},
    {164, 154, 44},   {165, 21, 3},     {166, 21, 9},     {167, 144, 22},   {168, 1, 12},      {169, 234, 18},
    {170, 73, 34},    {171, 181, 66},   {172, 22, 98},    {173, 83, 8},     {174, 167, 48},    {175, 138, 19},
    {176, 234, 3},    {177, 240, 20},   {178, 47, 24},    {179, 189, 29},   {180, 52, 47},     {181, 174, 4},
    {182, 229, 40},   {183, 85, 2},     {184, 159, 206},  {185, 186, 7},    {186, 72, 29},     {191, 92, 27},
    {192, 36, 54},    {193, 71, 26},    {194, 98, 33},    {195, 120, 37},   {200, 134, 42},    {201, 205, 14},
    {214, 69, 8},     {215, 101, 3},    {216, 50, 3},     {217, 202, 6},    {218, 17, 7},      {219, 162, 2},
    {225, 208, 73},   {226, 207, 8},    {230, 163, 42},   {231, 105, 40},   {232, 151, 65},    {233, 35, 182},
    {234, 150, 40},   {235, 179, 42},   {241, 90, 32},    {242, 104, 60},   {243, 85, 61},     {244, 95, 6},
    {245, 130, 2},    {246, 184, 38},   {247, 81, 19},    {248, 8, 254},    {249, 204, 36},    {250, 49, 30},
    {251, 170, 18},   {252, 44, 18},    {253, 83, 54},    {254, 46, 9},     {256, 71, 42},     {257, 131, 9},
    {258, 187, 232},  {259, 92, 237},   {260, 146, 14},   {261, 179, 61},   {262, 12, 23},     {263, 133, 255},
    {264, 49, 32},    {265, 26, 20},    {266, 193, 255},  {267, 35, 255},   {268, 14, 4},      {269, 109, 215},
    {270, 59, 20},    {271, 22, 53},    {275, 126, 32},   {276, 18, 50},    {277, 62, 30},     {280, 70, 33},
    {281, 48, 13},    {282, 123, 35},   {283, 74, 149},   {284, 99, 32},    {285, 137, 49},    {286, 210, 57},
    {287, 1, 23},     {288, 20, 23},    {290, 251, 46},   {291, 10, 57},    {295, 234, 12},    {296, 158, 41},
    {299, 19, 98},    {300, 217, 22},   {301, 243, 58},   {310, 28, 17},    {311, 95, 116},    {320, 243, 20},
    {321, 88, 2},     {322, 243, 149},  {323, 78, 147},   {324, 132, 146},  {330, 23, 167},    {331, 91, 233},
    {332, 236, 239},  {333, 231, 109},  {334, 72, 53},    {335, 225, 24},   {336, 245, 84},    {339, 199, 5},
    {340, 99, 70},    {345, 209, 21},   {350, 232, 252},  {360, 11, 25},    {361, 93, 33},     {370, 75, 109},
    {371, 10, 26},    {372, 26, 140},   {373, 117, 42},   {375, 251, 140},  {376, 199, 8},     {380, 232, 20},
    {385, 147, 133},  {386, 132, 16},   {387, 4, 72},     {388, 8, 37},     {390, 156, 240},   {395, 0, 212},
    {396, 50, 160},   {397, 182, 108},  {400, 110, 254},  {401, 183, 6},    {410, 160, 53},    {411, 106, 3},
    {412, 33, 6},     {413, 77, 7},     {435, 134, 46},   {436, 193, 9},    {437, 30, 1},      {440, 66, 35},
    {9000, 113, 137}, {9005, 117, 34},  {11000, 134, 52}, {11001, 15, 136}, {11002, 234, 180}, {11003, 64, 5},
    {11004, 11, 232}, {11005, 93, 230}, {11010, 46, 49},  {11011, 106, 44}, {11020, 205, 16},  {11030, 144, 44},
    {11031, 133, 44}, {11032, 85, 44},  {11033, 195, 37}, {11034, 79, 5},   {11035, 128, 8},   {11036, 177, 34},
    {11037, 130, 28}, {11038, 47, 38},  {11039, 142, 9},  {11040, 132, 44}, {11041, 208, 44},  {11042, 201, 44},
    {11043, 193, 44}, {11044, 189, 44}, {11060, 162, 78}, {12900, 114, 44}, {12901, 254, 59},  {12902, 140, 53},
    {12903, 249, 46}, {12904, 77, 54},  {12905, 49, 43},  {12915, 94, 249}, {12918, 139, 51},  {12919, 7, 18},
    {12920, 20, 5},
}};

// Ids, and the places of fields in the payload, bytes, of the messages that are understood.
struct MavlinkFields {
  struct Heartbeat {
    static constexpr std::uint32_t kId = 0;
    static constexpr std::size_t custom_mode = 0;      // uint32_t
    static constexpr std::size_t type = 4;             // uint8_t
    static constexpr std::size_t autopilot = 5;        // uint8_t
    static constexpr std::size_t base_mode = 6;        // uint8_t
    static constexpr std::size_t system_status = 7;    // uint8_t
    static constexpr std::size_t mavlink_version = 8;  // uint8_t
  };
  struct Attitude {
    static constexpr std::uint32_t kId = 30;
    static constexpr std::size_t time_boot_ms = 0;  // uint32_t
    static constexpr std::size_t roll = 4;          // float
    static constexpr std::size_t pitch = 8;         // float
    static constexpr std::size_t yaw = 12;          // float
    static constexpr std::size_t rollspeed = 16;    // float
    static constexpr std::size_t pitchspeed = 20;   // float
    static constexpr std::size_t yawspeed = 24;     // float
  };
  struct AttitudeQuaternion {
    static constexpr std::uint32_t kId = 31;
    static constexpr std::size_t time_boot_ms = 0;    // uint32_t
    static constexpr std::size_t q1 = 4;              // float
    static constexpr std::size_t q2 = 8;              // float
    static constexpr std::size_t q3 = 12;             // float
    static constexpr std::size_t q4 = 16;             // float
    static constexpr std::size_t rollspeed = 20;      // float
    static constexpr std::size_t pitchspeed = 24;     // float
    static constexpr std::size_t yawspeed = 28;       // float
    static constexpr std::size_t repr_offset_q = 32;  // float[4]
  };
  struct GlobalPositionInt {
    static constexpr std::uint32_t kId = 33;
    static constexpr std::size_t time_boot_ms = 0;   // uint32_t
    static constexpr std::size_t lat = 4;            // int32_t
    static constexpr std::size_t lon = 8;            // int32_t
    static constexpr std::size_t alt = 12;           // int32_t
    static constexpr std::size_t relative_alt = 16;  // int32_t
    static constexpr std::size_t vx = 20;            // int16_t
    static constexpr std::size_t vy = 22;            // int16_t
    static constexpr std::size_t vz = 24;            // int16_t
    static constexpr std::size_t hdg = 26;           // uint16_t
  };
  struct Timesync {
    static constexpr std::uint32_t kId = 111;
    static constexpr std::size_t tc1 = 0;                // int64_t
    static constexpr std::size_t ts1 = 8;                // int64_t
    static constexpr std::size_t target_system = 16;     // uint8_t
    static constexpr std::size_t target_component = 17;  // uint8_t
  };
  struct Wind {
    static constexpr std::uint32_t kId = 168;
    static constexpr std::size_t direction = 0;  // float
    static constexpr std::size_t speed = 4;      // float
    static constexpr std::size_t speed_z = 8;    // float
  };
  struct WindCov {
    static constexpr std::uint32_t kId = 231;
    static constexpr std::size_t time_usec = 0;        // uint64_t
    static constexpr std::size_t wind_x = 8;           // float
    static constexpr std::size_t wind_y = 12;          // float
    static constexpr std::size_t wind_z = 16;          // float
    static constexpr std::size_t var_horiz = 20;       // float
    static constexpr std::size_t var_vert = 24;        // float
    static constexpr std::size_t wind_alt = 28;        // float
    static constexpr std::size_t horiz_accuracy = 32;  // float
    static constexpr std::size_t vert_accuracy = 36;   // float
  };
  struct NamedValueFloat {
    static constexpr std::uint32_t kId = 251;
    static constexpr std::size_t time_boot_ms = 0;  // uint32_t
    static constexpr std::size_t value = 4;         // float
    static constexpr std::size_t name = 8;          // char[10]
  };
  struct Statustext {
    static constexpr std::uint32_t kId = 253;
    static constexpr std::size_t severity = 0;    // uint8_t
    static constexpr std::size_t text = 1;        // char[50]
    static constexpr std::size_t id = 51;         // uint16_t
    static constexpr std::size_t chunk_seq = 53;  // uint8_t
  };
  struct GimbalDeviceAttitudeStatus {
    static constexpr std::uint32_t kId = 285;
    static constexpr std::size_t time_boot_ms = 0;         // uint32_t
    static constexpr std::size_t q = 4;                    // float[4]
    static constexpr std::size_t angular_velocity_x = 20;  // float
    static constexpr std::size_t angular_velocity_y = 24;  // float
    static constexpr std::size_t angular_velocity_z = 28;  // float
    static constexpr std::size_t failure_flags = 32;       // uint32_t
    static constexpr std::size_t flags = 36;               // uint16_t
    static constexpr std::size_t target_system = 38;       // uint8_t
    static constexpr std::size_t target_component = 39;    // uint8_t
    static constexpr std::size_t delta_yaw = 40;           // float
    static constexpr std::size_t delta_yaw_velocity = 44;  // float
    static constexpr std::size_t gimbal_device_id = 48;    // uint8_t
  };
  struct EscStatus {
    static constexpr std::uint32_t kId = 291;
    static constexpr std::size_t time_usec = 0;  // uint64_t
    static constexpr std::size_t rpm = 8;        // int32_t[4]
    static constexpr std::size_t voltage = 24;   // float[4]
    static constexpr std::size_t current = 40;   // float[4]
    static constexpr std::size_t index = 56;     // uint8_t
  };
  struct OnboardComputerStatus {
    static constexpr std::uint32_t kId = 390;
    static constexpr std::size_t time_usec = 0;            // uint64_t
    static constexpr std::size_t uptime = 8;               // uint32_t
    static constexpr std::size_t ram_usage = 12;           // uint32_t
    static constexpr std::size_t ram_total = 16;           // uint32_t
    static constexpr std::size_t storage_type = 20;        // uint32_t[4]
    static constexpr std::size_t storage_usage = 36;       // uint32_t[4]
    static constexpr std::size_t storage_total = 52;       // uint32_t[4]
    static constexpr std::size_t link_type = 68;           // uint32_t[6]
    static constexpr std::size_t link_tx_rate = 92;        // uint32_t[6]
    static constexpr std::size_t link_rx_rate = 116;       // uint32_t[6]
    static constexpr std::size_t link_tx_max = 140;        // uint32_t[6]
    static constexpr std::size_t link_rx_max = 164;        // uint32_t[6]
    static constexpr std::size_t fan_speed = 188;          // int16_t[4]
    static constexpr std::size_t type = 196;               // uint8_t
    static constexpr std::size_t cpu_cores = 197;          // uint8_t[8]
    static constexpr std::size_t cpu_combined = 205;       // uint8_t[10]
    static constexpr std::size_t gpu_cores = 215;          // uint8_t[4]
    static constexpr std::size_t gpu_combined = 219;       // uint8_t[10]
    static constexpr std::size_t temperature_board = 229;  // int8_t
    static constexpr std::size_t temperature_core = 230;   // int8_t[8]
    static constexpr std::size_t status_flags = 238;       // uint16_t
  };
  struct EscTelemetry1To4 {
    static constexpr std::uint32_t kId = 11030;
    static constexpr std::size_t voltage = 0;        // uint16_t[4]
    static constexpr std::size_t current = 8;        // uint16_t[4]
    static constexpr std::size_t totalcurrent = 16;  // uint16_t[4]
    static constexpr std::size_t rpm = 24;           // uint16_t[4]
    static constexpr std::size_t count = 32;         // uint16_t[4]
    static constexpr std::size_t temperature = 40;   // uint8_t[4]
  };
  struct EscTelemetry5To8 {
    static constexpr std::uint32_t kId = 11031;
    static constexpr std::size_t voltage = 0;        // uint16_t[4]
    static constexpr std::size_t current = 8;        // uint16_t[4]
    static constexpr std::size_t totalcurrent = 16;  // uint16_t[4]
    static constexpr std::size_t rpm = 24;           // uint16_t[4]
    static constexpr std::size_t count = 32;         // uint16_t[4]
    static constexpr std::size_t temperature = 40;   // uint8_t[4]
  };
  struct EscTelemetry9To12 {
    static constexpr std::uint32_t kId = 11032;
    static constexpr std::size_t voltage = 0;        // uint16_t[4]
    static constexpr std::size_t current = 8;        // uint16_t[4]
    static constexpr std::size_t totalcurrent = 16;  // uint16_t[4]
    static constexpr std::size_t rpm = 24;           // uint16_t[4]
    static constexpr std::size_t count = 32;         // uint16_t[4]
    static constexpr std::size_t temperature = 40;   // uint8_t[4]
  };
};

}  // namespace drivers
