#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct evp_md_ctx_st;  // OpenSSL's digest state

namespace gradslc {

/// SHA-256 (FIPS 180-4) of bytes that arrive in pieces, by OpenSSL.
class Sha256 {
 public:
  Sha256();
  void add(std::span<const std::byte> bytes);
  void add(std::string_view text) { add(std::as_bytes(std::span(text))); }
  /// A number's eight bytes, lowest first.
  void add_number(std::uint64_t value);
  /// The digest in 64 lower-case hexadecimal digits; nothing may be added afterwards.
  std::string finish();

 private:
  struct Release {
    void operator()(evp_md_ctx_st* state) const;
  };
  std::unique_ptr<evp_md_ctx_st, Release> state_;
};

std::string sha256(std::string_view text);
/// Of a file's bytes, as sha256sum prints it. Error (input) where it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace gradslc
