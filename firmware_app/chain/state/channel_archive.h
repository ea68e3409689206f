#pragma once

namespace app {

// Fields of a channel for a byte archive (byte_archive.h), except whether it is a witness.
template <class Archive, class Channel>
void describe_channel(Archive& archive, Channel& channel) {
  archive.value(channel.region);
  archive.list(channel.name);
  archive.value(channel.direction_u);
  archive.value(channel.direction_v);
  archive.value(channel.row_delay_s);
  archive.value(channel.is_base);
  archive.value(channel.n_integrations);
}

}  // namespace app
