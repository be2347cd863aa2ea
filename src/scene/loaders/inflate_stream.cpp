#include "scene/loaders/inflate_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "core/error.h"

namespace gradslc {
namespace {

constexpr std::size_t k_max_expansion = 1032;

}  // namespace

InflateStream::InflateStream(std::istream& source, std::size_t size, std::string file)
    : source_(source), unread_(size), file_(std::move(file)), position_(static_cast<std::size_t>(source.tellg())) {
  if (inflateInit(&state_) != Z_OK) throw_failure(file_, "zlib cannot be started");
}

InflateStream::~InflateStream() { inflateEnd(&state_); }

bool InflateStream::refill() {
  const std::size_t count = std::min(unread_, buffer_.size());
  if (count == 0 || !source_.read(reinterpret_cast<char*>(buffer_.data()), static_cast<std::streamsize>(count)))
    return false;
  unread_ -= count;
  position_ += count;
  state_.next_in = buffer_.data();
  state_.avail_in = static_cast<uInt>(count);
  return true;
}

void InflateStream::read(void* target, std::size_t size) {
  auto* next = static_cast<unsigned char*>(target);
  while (size > 0) {
    const std::size_t step = std::min<std::size_t>(size, std::numeric_limits<uInt>::max());
    state_.next_out = next;
    state_.avail_out = static_cast<uInt>(step);
    if (state_.avail_in == 0 && !refill()) fail("the compressed data end too early");
    const int result = inflate(&state_, Z_NO_FLUSH);
    const std::size_t written = step - state_.avail_out;
    next += written;
    size -= written;
    if (result == Z_STREAM_END && size > 0) fail("the compressed data hold less than their header says");
    if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR)
      fail(fmt::format("the compressed data are damaged ({})", state_.msg ? state_.msg : "zlib gives no reason"));
  }
}

std::size_t InflateStream::max_remaining() const {
  const std::size_t compressed = unread_ + state_.avail_in;
  // A little more may wait inside zlib: its window, and a symbol that has begun.
  return k_max_expansion * (compressed + 1) + 65536;
}

void InflateStream::fail(const std::string& message) const {
  throw_input_error(file_, fmt::format("byte {}: {}", position_ - state_.avail_in, message));
}

}  // namespace gradslc
