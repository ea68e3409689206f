#include "drivers/exchange/mcap_file.h"

extern "C" {
#include <libavutil/crc.h>
}

#include <algorithm>
#include <concepts>

namespace drivers {
namespace {

constexpr std::size_t kChunkBytes = 1U << 20U;
constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
enum Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0b,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f
};

template <std::unsigned_integral Number>
void append(std::string& out, Number number) {  // little-endian
  for (std::size_t i = 0; i < sizeof(Number); ++i) out.push_back(static_cast<char>((number >> (8 * i)) & 0xffU));
}
void append(std::string& out, std::string_view text) {
  append(out, static_cast<std::uint32_t>(text.size()));
  out.append(text);
}

std::string record(Opcode opcode, std::string_view content) {
  std::string out(1, static_cast<char>(opcode));
  append(out, static_cast<std::uint64_t>(content.size()));
  out.append(content);
  return out;
}

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) noexcept {
  const AVCRC* table = av_crc_get_table(AV_CRC_32_IEEE_LE);
  return ~av_crc(table, ~before, reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

void McapFile::Span::add(std::uint64_t t_ns) noexcept {
  first_ns = std::min(first_ns, t_ns);
  last_ns = std::max(last_ns, t_ns);
}

McapFile::McapFile(const std::string& path) : file_(path, OldFile::kKeepUntilCommit) {
  put(kMagic);
  std::string header;
  append(header, std::string_view());  // profile
  append(header, std::string_view("hovermodal"));
  put(record(kHeader, header));
}

void McapFile::put(std::string_view bytes) {
  append_text(file_.buffer(), bytes);
  (void)file_.end_line();
  position_ += bytes.size();
  crc_ = crc32(bytes, crc_);
}

std::uint16_t McapFile::add_channel(std::string_view topic, std::string_view schema_name, std::string_view schema) {
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  std::string content;
  append(content, id);
  append(content, schema_name);
  append(content, std::string_view("jsonschema"));
  append(content, schema);
  Channel channel;
  channel.schema_record = record(kSchema, content);
  content.clear();
  append(content, id);
  append(content, id);  // its schema
  append(content, topic);
  append(content, std::string_view("json"));
  append(content, std::uint32_t{0});  // no metadata
  channel.channel_record = record(kChannel, content);
  channels_.push_back(std::move(channel));
  return id;
}

void McapFile::message(std::uint16_t channel, std::uint64_t t_ns, std::string_view json) {
  if (!has_channels_written_) {
    for (const Channel& one : channels_) chunk_ += one.schema_record + one.channel_record;
    has_channels_written_ = true;
  }
  std::string& index = index_[channel];
  append(index, t_ns);
  append(index, static_cast<std::uint64_t>(chunk_.size()));
  chunk_times_.add(t_ns);
  std::string content;
  append(content, channel);
  append(content, static_cast<std::uint32_t>(channels_[channel - 1U].n_messages++));
  append(content, t_ns);
  append(content, t_ns);
  content.append(json);
  chunk_ += record(kMessage, content);
  if (chunk_.size() >= kChunkBytes) end_chunk();
}

void McapFile::end_chunk() {
  if (chunk_.empty()) return;
  const std::uint64_t start = position_, size = chunk_.size();
  std::string content;
  append(content, chunk_times_.first());
  append(content, chunk_times_.last_ns);
  append(content, size);
  append(content, crc32(chunk_));
  append(content, std::string_view());  // not compressed
  append(content, size);
  content += chunk_;
  put(record(kChunk, content));
  const std::uint64_t length = position_ - start;

  std::string places;
  for (const auto& [channel, entries] : index_) {
    append(places, channel);
    append(places, position_);
    std::string index;
    append(index, channel);
    append(index, std::string_view(entries));
    put(record(kMessageIndex, index));
  }
  std::string about;
  append(about, chunk_times_.first());
  append(about, chunk_times_.last_ns);
  append(about, start);
  append(about, length);
  append(about, std::string_view(places));
  append(about, position_ - start - length);
  append(about, std::string_view());
  append(about, size);
  append(about, size);
  chunk_indices_ += record(kChunkIndex, about);

  all_times_.add(chunk_times_.first());
  all_times_.add(chunk_times_.last_ns);
  ++n_chunks_;
  chunk_.clear(), index_.clear(), chunk_times_ = {};
}

// Summary, its offsets, and the footer.
std::string McapFile::summary() const {
  std::string schemas, channels, counts, statistics;
  std::uint64_t n_messages = 0;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    schemas += channels_[c].schema_record;
    channels += channels_[c].channel_record;
    append(counts, static_cast<std::uint16_t>(c + 1));
    append(counts, channels_[c].n_messages);
    n_messages += channels_[c].n_messages;
  }
  append(statistics, n_messages);
  append(statistics, static_cast<std::uint16_t>(channels_.size()));
  append(statistics, static_cast<std::uint32_t>(channels_.size()));
  append(statistics, std::uint32_t{0});  // attachments
  append(statistics, std::uint32_t{0});  // metadata
  append(statistics, n_chunks_);
  append(statistics, all_times_.first());
  append(statistics, all_times_.last_ns);
  append(statistics, std::string_view(counts));

  const std::uint64_t start = position_;
  std::string out, offsets;
  const auto group = [&](Opcode opcode, const std::string& records) {
    if (records.empty()) return;
    std::string offset;
    append(offset, static_cast<std::uint8_t>(opcode));
    append(offset, start + out.size());
    append(offset, static_cast<std::uint64_t>(records.size()));
    offsets += record(kSummaryOffset, offset);
    out += records;
  };
  group(kSchema, schemas);
  group(kChannel, channels);
  group(kStatistics, record(kStatistics, statistics));
  group(kChunkIndex, chunk_indices_);
  const std::uint64_t offsets_start = start + out.size();
  out += offsets;
  // The checksum covers the footer up to itself.
  std::string footer(1, static_cast<char>(kFooter));
  append(footer, std::uint64_t{20});
  append(footer, start);
  append(footer, offsets_start);
  out += footer;
  append(out, crc32(out));
  return out;
}

void McapFile::commit() {
  end_chunk();
  std::string end;
  append(end, crc_);
  put(record(kDataEnd, end));
  put(summary());
  put(kMagic);
  file_.commit();
}

}  // namespace drivers
