#include "robot/logs/foreign/file_bytes.h"

#include <bzlib.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "base/error.h"

namespace rubble::robot {
namespace {

constexpr int kGzipOnly = 16 + MAX_WBITS;

bool is_gzip(const std::string& bytes) { return bytes.size() >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b'; }

class Inflater {
 public:
  Inflater() { inflateInit2(&stream_, kGzipOnly); }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Inflates one gzip member that starts at `from`; returns where it ends. Throws InputError.
  std::size_t member(const std::string& bytes, std::size_t from, std::string& out, const std::string& path) {
    inflateReset(&stream_);
    std::size_t at = from;
    int status = Z_OK;
    while (status != Z_STREAM_END) {
      constexpr std::size_t kChunk = std::size_t{1} << 20;
      const std::size_t written = out.size();
      const std::size_t offered = std::min(bytes.size() - at, kChunk);
      out.resize(written + kChunk);
      stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + at));
      stream_.avail_in = static_cast<uInt>(offered);
      stream_.next_out = reinterpret_cast<Bytef*>(&out[written]);
      stream_.avail_out = static_cast<uInt>(kChunk);
      status = inflate(&stream_, Z_NO_FLUSH);
      at += offered - stream_.avail_in;
      out.resize(written + kChunk - stream_.avail_out);
      const bool starved = at == bytes.size() && stream_.avail_out != 0;
      if (status != Z_STREAM_END && (status == Z_BUF_ERROR || status == Z_OK) && starved)
        throw InputError(path + ": the gzip data stop at byte " + std::to_string(at) + " (after " +
                         std::to_string(out.size()) + " bytes of content) without their end; copy the file again, or " +
                         "save what is there with: zcat '" + path + "' > part");
      if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
        throw InputError(path + ": the gzip data are damaged near byte " + std::to_string(at) +
                         "; copy the file again, 'gzip -t' checks it");
    }
    return at;
  }

 private:
  z_stream stream_{};
};

bool is_bzip2(const std::string& bytes) { return bytes.size() >= 4 && bytes.compare(0, 3, "BZh") == 0; }

class Bunzipper {
 public:
  Bunzipper() { BZ2_bzDecompressInit(&stream_, 0, 0); }
  ~Bunzipper() { BZ2_bzDecompressEnd(&stream_); }
  Bunzipper(const Bunzipper&) = delete;
  Bunzipper& operator=(const Bunzipper&) = delete;

  /// Unpacks one bzip2 stream that starts at `from`; returns where it ends. Throws InputError.
  std::size_t member(const std::string& bytes, std::size_t from, std::string& out, const std::string& path) {
    std::size_t at = from;
    int status = BZ_OK;
    while (status != BZ_STREAM_END) {
      constexpr std::size_t kChunk = std::size_t{1} << 20;
      const std::size_t written = out.size();
      const std::size_t offered = std::min(bytes.size() - at, kChunk);
      out.resize(written + kChunk);
      stream_.next_in = const_cast<char*>(bytes.data() + at);
      stream_.avail_in = static_cast<unsigned>(offered);
      stream_.next_out = &out[written];
      stream_.avail_out = static_cast<unsigned>(kChunk);
      status = BZ2_bzDecompress(&stream_);
      at += offered - stream_.avail_in;
      out.resize(written + kChunk - stream_.avail_out);
      if (status == BZ_OK && at == bytes.size() && stream_.avail_out != 0)
        throw InputError(path + ": the bzip2 data stop at byte " + std::to_string(at) + " (after " +
                         std::to_string(out.size()) + " bytes of content) without their end; copy the file again");
      if (status != BZ_OK && status != BZ_STREAM_END)
        throw InputError(path + ": the bzip2 data are damaged near byte " + std::to_string(at) +
                         "; copy the file again, 'bzip2 -t' checks it");
    }
    return at;
  }

 private:
  bz_stream stream_{};
};

}  // namespace

std::string read_file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw InputError(path + ": is a folder; give the log file inside it");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be opened (" + std::strerror(errno) + "); give the path of a log");
  std::string bytes;
  std::vector<char> chunk(std::size_t{1} << 20);
  while (file.read(chunk.data(), static_cast<std::streamsize>(chunk.size())) || file.gcount() > 0)
    bytes.append(chunk.data(), static_cast<std::size_t>(file.gcount()));
  if (file.bad()) throw InputError(path + ": cannot be read to its end; check the disk and copy the file again");
  if (bytes.empty()) throw InputError(path + ": is empty; give a log that holds data");
  return bytes;
}

std::string unpacked(std::string bytes, const std::string& path) {
  if (is_bzip2(bytes)) {
    std::string out;
    for (std::size_t at = 0; at < bytes.size();) at = Bunzipper().member(bytes, at, out, path);
    if (out.empty()) throw InputError(path + ": holds no data behind its bzip2 header; give a log that holds data");
    return out;
  }
  if (!is_gzip(bytes)) return bytes;
  std::string out;
  Inflater inflater;
  // A gzip file may be several members one after the other, and tape tools pad it with zeros.
  for (std::size_t at = 0; at < bytes.size() && bytes[at] != 0;) at = inflater.member(bytes, at, out, path);
  if (out.empty()) throw InputError(path + ": holds no data behind its gzip header; give a log that holds data");
  return out;
}

void write_gzip(const std::string& path, const std::string& bytes) {
  gzFile file = gzopen(path.c_str(), "wb");
  bool good = file != nullptr;
  for (std::size_t at = 0; good && at < bytes.size();) {
    const auto size = static_cast<unsigned>(std::min<std::size_t>(bytes.size() - at, std::size_t{1} << 20));
    good = gzwrite(file, bytes.data() + at, size) == static_cast<int>(size);
    at += size;
  }
  if (file != nullptr) good = gzclose(file) == Z_OK && good;
  if (!good) throw RunError(path + ": cannot be written; check the folder and the free space");
}

}  // namespace rubble::robot
