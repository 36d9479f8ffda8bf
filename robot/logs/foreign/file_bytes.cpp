#include "robot/logs/foreign/file_bytes.h"

#include <bzlib.h>
#include <zlib.h>

#include <algorithm>

#include "base/error.h"
#include "base/text/new_file.h"

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
      check_inflated(out.size(), bytes.size(), path);
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
      check_inflated(out.size(), bytes.size(), path);
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

std::size_t most_inflated(std::size_t packed) {
  constexpr std::size_t kAlways = std::size_t{64} << 20;
  return std::min(kLargestLog, kAlways + 40 * std::min(packed, kLargestLog));
}

void check_inflated(std::size_t inflated, std::size_t packed, const std::string& path) {
  if (inflated <= most_inflated(packed)) return;
  throw InputError(path + ": its " + std::to_string(packed) + " bytes unpack to more than " +
                   std::to_string(most_inflated(packed) >> 20) +
                   " MB, which no log does; if it is one, unpack it first and give the result");
}

InputRules log_rules(Pipes pipes) {
  return {"a log", kLargestLog, "the most that is read at once; cut the log into parts", pipes};
}

std::string read_file(const std::string& path) {
  InputFile file(path, log_rules(Pipes::Named));
  return read_file(file);
}

std::string read_file(InputFile& file) {
  std::string bytes = file.rest();
  if (bytes.empty()) throw InputError(file.path() + ": is empty; give a log that holds data");
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

struct GzipFile::Impl {
  NewFile file;
  z_stream stream{};

  explicit Impl(const std::string& path) : file(path) {
    constexpr int kMemory = 8;  // zlib's usual
    if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzipOnly, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
      throw RunError(path + ": cannot be packed for want of memory");
  }
  ~Impl() { deflateEnd(&stream); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void pack(std::string_view bytes, int flush) {
    std::string packed(std::size_t{1} << 16, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    do {
      stream.next_out = reinterpret_cast<Bytef*>(packed.data());
      stream.avail_out = static_cast<uInt>(packed.size());
      deflate(&stream, flush);
      file.put(std::string_view(packed).substr(0, packed.size() - stream.avail_out));
    } while (stream.avail_out == 0);
  }
};

GzipFile::GzipFile(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}

GzipFile::~GzipFile() = default;

void GzipFile::put(std::string_view bytes) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;  // zlib counts in 32 bits
  for (; !bytes.empty(); bytes.remove_prefix(std::min(kPiece, bytes.size())))
    impl_->pack(bytes.substr(0, kPiece), Z_NO_FLUSH);
}

void GzipFile::keep() {
  impl_->pack({}, Z_FINISH);
  impl_->file.keep();
}

void write_gzip(const std::string& path, const std::string& bytes) {
  GzipFile file(path);
  file.put(bytes);
  file.keep();
}

}  // namespace rubble::robot
