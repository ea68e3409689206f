#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/storage/csv_writer.h"

namespace drivers {

// Writes the container MCAP 0 (mcap.dev/spec): messages in uncompressed chunks with their index, a summary at the end,
// all checksums. Same calls, same bytes. One thread.
class McapFile {
 public:
  explicit McapFile(const std::string& path);  // throws FileError

  // Messages as JSON, described by a JSON schema. Returns the channel's number. Before the first message.
  [[nodiscard]] std::uint16_t add_channel(std::string_view topic, std::string_view schema_name,
                                          std::string_view schema);
  // `t_ns` from 0 on, in any order.
  void message(std::uint16_t channel, std::uint64_t t_ns, std::string_view json);

  void commit();  // throws FileError

 private:
  struct Span {  // of times
    std::uint64_t first_ns = UINT64_MAX, last_ns = 0;
    void add(std::uint64_t t_ns) noexcept;
    [[nodiscard]] std::uint64_t first() const noexcept { return first_ns == UINT64_MAX ? 0 : first_ns; }
  };
  struct Channel {
    std::string schema_record, channel_record;
    std::uint64_t n_messages = 0;
  };

  void put(std::string_view bytes);
  void end_chunk();
  std::string summary() const;

  CsvWriter file_;
  std::uint64_t position_ = 0;
  std::uint32_t crc_ = 0;  // of all bytes before the end of the data
  std::vector<Channel> channels_;
  bool has_channels_written_ = false;
  std::string chunk_;
  Span chunk_times_, all_times_;
  std::map<std::uint16_t, std::string> index_;  // per channel: times and places in the chunk
  std::string chunk_indices_;
  std::uint32_t n_chunks_ = 0;
};

// CRC-32 as in Ethernet, of `bytes` after others whose checksum is `before`.
[[nodiscard]] std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0) noexcept;

}  // namespace drivers
