// The four index accesses of the ring, and both exchanges of the triple buffer, each in a separate function, so that
// their compiled instructions can be inspected (tools/figures/runtime.sh, arm64).
#include "rt/spsc_ring.h"
#include "rt/triple_buffer.h"

extern "C" {
std::uint64_t* ring_try_claim(rt::RingWriter<std::uint64_t>& writer) { return writer.try_claim(); }
void ring_publish(rt::RingWriter<std::uint64_t>& writer) { writer.publish(); }
const std::uint64_t* ring_front(rt::RingReader<std::uint64_t>& reader) { return reader.front(); }
void ring_pop(rt::RingReader<std::uint64_t>& reader) { reader.pop(); }
void triple_publish(rt::TripleBuffer<std::uint64_t>& buffer) { buffer.publish(); }
bool triple_refresh(rt::TripleBuffer<std::uint64_t>& buffer) { return buffer.refresh(); }
}
