#include "experiments/sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>

#include "core/error.h"
#include "core/file.h"

namespace gradslc {
namespace {

void require(int succeeded) {
  if (succeeded != 1) throw_failure("", "OpenSSL cannot compute a SHA-256 checksum");
}

}  // namespace

void Sha256::Release::operator()(evp_md_ctx_st* state) const { EVP_MD_CTX_free(state); }

Sha256::Sha256() : state_(EVP_MD_CTX_new()) { require(EVP_DigestInit_ex(state_.get(), EVP_sha256(), nullptr)); }

void Sha256::add(std::span<const std::byte> bytes) {
  require(EVP_DigestUpdate(state_.get(), bytes.data(), bytes.size()));
}

void Sha256::add_number(std::uint64_t value) {
  std::array<std::byte, 8> bytes;
  for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<std::byte>(value >> (8 * i) & 0xff);
  add(bytes);
}

std::string Sha256::finish() {
  std::array<unsigned char, 32> digest;
  require(EVP_DigestFinal_ex(state_.get(), digest.data(), nullptr));
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

std::string sha256(std::string_view text) {
  Sha256 hash;
  hash.add(text);
  return hash.finish();
}

std::string sha256_of_file(const std::filesystem::path& path) { return sha256(read_file(path)); }

}  // namespace gradslc
