#include "base/digest.h"

#include <openssl/evp.h>
#include <zlib.h>

#include <array>
#include <limits>
#include <memory>

#include "base/error.h"
#include "base/text/input_file.h"
#include "base/text/words.h"

namespace rubble {
namespace {

struct FreeContext {
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new()) {
    if (!context_ || EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1) fail();
  }

  void add(std::string_view bytes) {
    if (EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) != 1) fail();
  }

  std::string hex() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
    unsigned size = 0;
    if (EVP_DigestFinal_ex(context_.get(), digest.data(), &size) != 1) fail();
    std::string text;
    for (unsigned i = 0; i < size; ++i) text += hex_digits(digest[i]);
    return text;
  }

 private:
  [[noreturn]] static void fail() { throw RunError("SHA-256 is not available in OpenSSL; check its configuration"); }

  std::unique_ptr<EVP_MD_CTX, FreeContext> context_;
};

}  // namespace

std::string sha256_of_text(std::string_view text) {
  Sha256 sha;
  sha.add(text);
  return sha.hex();
}

std::string sha256_of_file(const std::string& path) {
  InputRules rules;
  rules.most = std::numeric_limits<std::size_t>::max();  // nothing is kept of it
  InputFile file(path, rules);
  Sha256 sha;
  std::array<char, 65536> buffer;
  while (const std::size_t got = file.read(buffer.data(), buffer.size())) sha.add({buffer.data(), got});
  return sha.hex();
}

std::uint32_t crc32_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<z_size_t>(bytes.size())));
}

}  // namespace rubble
