// Maps with a graph: the bytes of a file, and the payload behind its sums, which keep random bytes from coming so far.
// What was taken is written and read again as the same bytes.
#include <zlib.h>

#include <cstdlib>
#include <string>

#include "base/bytes.h"
#include "base/digest.h"
#include "fuzz/harness.h"
#include "slam/robust/map/saved_map.h"

RUBBLE_FUZZ_TARGET {
  using namespace rubble;
  fuzz::refuses_or_reads([&] { slam::decode_map(fuzz::text_of(data, size), "input.rmap"); });
  uLongf packed_size = compressBound(static_cast<uLong>(size));
  std::string packed(packed_size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &packed_size, data, static_cast<uLong>(size), 1) != Z_OK)
    std::abort();
  packed.resize(packed_size);
  std::string head;
  ByteWriter out(head);
  for (const std::size_t length : {size, packed.size()}) {
    out.u32(static_cast<std::uint32_t>(length));
    out.u32(0);
  }
  out.u32(crc32_of(packed));
  out.u32(crc32_of(head));
  fuzz::refuses_or_reads([&] {
    const std::string once = encode_map(slam::decode_map("RUBBLE MAP 2\n" + head + packed, "input.rmap"));
    if (encode_map(slam::decode_map(once, "again.rmap")) != once) std::abort();
  });
  return 0;
}
