#include "base/image/tiff_file.h"

#include <geotiff/xtiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "base/error.h"
#include "base/text/input_file.h"
#include "base/text/words.h"

namespace rubble {
namespace {

void keep_first(std::string& kept, const char* format, va_list arguments) {
  if (!kept.empty()) return;
  char text[300];
  std::vsnprintf(text, sizeof text, format, arguments);
  kept = one_line(text);
  while (!kept.empty() && kept.back() == '.') kept.pop_back();
}

// Both return 1: handled, libtiff does not print.
int keep_error(TIFF*, void* user, const char*, const char* format, va_list arguments) {
  keep_first(static_cast<TiffComplaint*>(user)->text, format, arguments);
  return 1;
}

int keep_lost_tag(TIFF*, void* user, const char*, const char* format, va_list arguments) {
  const bool is_lost = std::strncmp(format, "IO error", 8) == 0;  // other warnings are about harmless deviations
  if (is_lost) keep_first(static_cast<TiffComplaint*>(user)->lost_tag, format, arguments);
  return 1;
}

struct FreeOptions {
  void operator()(TIFFOpenOptions* options) const { TIFFOpenOptionsFree(options); }
};

std::unique_ptr<TIFFOpenOptions, FreeOptions> quiet(TiffComplaint& complaint) {
  XTIFFInitialize();  // registers the GeoTIFF tags
  std::unique_ptr<TIFFOpenOptions, FreeOptions> options(TIFFOpenOptionsAlloc());
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_error, &complaint);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), keep_lost_tag, &complaint);
  return options;
}

/// libtiff's view of a string as a file.
struct Memory {
  std::string* bytes;
  std::size_t at = 0;
};

tmsize_t read_memory(thandle_t handle, void* data, tmsize_t size) {
  auto& memory = *static_cast<Memory*>(handle);
  const std::size_t left = memory.bytes->size() - std::min(memory.at, memory.bytes->size());
  const std::size_t count = std::min(static_cast<std::size_t>(size), left);
  std::memcpy(data, memory.bytes->data() + std::min(memory.at, memory.bytes->size()), count);
  memory.at += count;
  return static_cast<tmsize_t>(count);
}

tmsize_t write_memory(thandle_t handle, void* data, tmsize_t size) {
  auto& memory = *static_cast<Memory*>(handle);
  const std::size_t end = memory.at + static_cast<std::size_t>(size);
  try {
    if (end > memory.bytes->size()) memory.bytes->resize(end);
  } catch (const std::bad_alloc&) {
    return -1;  // nothing may be thrown through the library's C
  }
  std::memcpy(memory.bytes->data() + memory.at, data, static_cast<std::size_t>(size));
  memory.at = end;
  return size;
}

toff_t seek_memory(thandle_t handle, toff_t offset, int whence) {
  auto& memory = *static_cast<Memory*>(handle);
  if (whence == SEEK_SET) memory.at = offset;
  if (whence == SEEK_CUR) memory.at += offset;
  if (whence == SEEK_END) memory.at = memory.bytes->size() + offset;
  return memory.at;
}

int close_memory(thandle_t handle) {
  delete static_cast<Memory*>(handle);
  return 0;
}

toff_t size_of_memory(thandle_t handle) { return static_cast<Memory*>(handle)->bytes->size(); }

}  // namespace

TiffFile open_tiff(const std::string& path, TiffComplaint& complaint) {
  require_input(path, image_rules());                                      // libtiff waits at pipes
  TiffFile tiff(TIFFOpenExt(path.c_str(), "rm", quiet(complaint).get()));  // m: a file that shrinks is no crash
  if (!tiff) {
    std::string why = complaint.text;  // begins with the path
    if (why.compare(0, path.size() + 2, path + ": ") == 0) why.erase(0, path.size() + 2);
    throw InputError(path + ": is no TIFF that can be read, or a part of one (" + why + "); copy or export it again");
  }
  if (!complaint.lost_tag.empty())
    throw InputError(path + ": is truncated (" + complaint.lost_tag + "); copy it again");
  return tiff;
}

TiffFile create_tiff(std::string& bytes, TiffComplaint& complaint) {
  auto memory = std::make_unique<Memory>(Memory{&bytes});
  TIFF* const tiff = TIFFClientOpenExt("memory", "w", memory.get(), read_memory, write_memory, seek_memory,
                                       close_memory, size_of_memory, nullptr, nullptr, quiet(complaint).get());
  if (tiff == nullptr) throw RunError("TIFF in memory: " + complaint.text);
  memory.release();  // closed by libtiff
  return TiffFile(tiff);
}

}  // namespace rubble
