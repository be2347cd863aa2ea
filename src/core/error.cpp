#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>
#include <vector>

namespace gradslc {
namespace {

/// Bytes of the word or quoted string that begins at `text`; at least 1.
std::size_t token_length(std::string_view text) {
  if (text.empty()) return 1;
  if (text.front() == '"') {
    const std::size_t end = text.find('"', 1);
    return end == std::string_view::npos ? 1 : end + 1;
  }
  const auto is_word = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '.' || c == '-' || c == '+';
  };
  const auto end = std::find_if_not(text.begin(), text.end(), is_word);
  return std::max<std::size_t>(1, static_cast<std::size_t>(end - text.begin()));
}

constexpr bool continues_utf8(char c) { return (static_cast<unsigned char>(c) & 0xc0u) == 0x80u; }

/// A caret under byte column `column` (1-based) of `line`, and tildes under the rest of the token there.
std::string underline(std::string_view line, std::size_t column) {
  std::string text;
  const std::size_t begin = std::min(column - 1, line.size());
  for (const char c : line.substr(0, begin))
    if (!continues_utf8(c)) text += c == '\t' ? '\t' : ' ';
  const std::string_view rest = line.substr(begin);
  const std::string_view token = rest.substr(0, token_length(rest));
  const auto characters = std::count_if(token.begin(), token.end(), [](char c) { return !continues_utf8(c); });
  return text + "^" + std::string(static_cast<std::size_t>(std::max<std::ptrdiff_t>(characters - 1, 0)), '~');
}

std::string format_error(const SourcePosition& where, const std::string& message) {
  std::string text;
  if (!where.file.empty()) {
    text += where.file;
    if (where.line > 0) text += fmt::format(":{}", where.line);
    if (where.line > 0 && where.column > 0) text += fmt::format(":{}", where.column);
    text += ": ";
  }
  text += "error: ";
  if (!where.pointer.empty()) text += where.pointer + ": ";
  text += message;
  if (!where.excerpt.empty() && where.line > 0) {
    text += fmt::format("\n{:5} | {}", where.line, where.excerpt);
    if (where.column > 0)
      text += fmt::format("\n{:5} | {}", "", underline(where.excerpt, static_cast<std::size_t>(where.column)));
  }
  return text;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, diagonal + 1, row[j] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

Error::Error(Kind kind, SourcePosition where, std::string message)
    : kind_(kind), where_(std::move(where)), message_(std::move(message)), text_(format_error(where_, message_)) {}

void throw_input_error(SourcePosition where, std::string message) {
  throw Error(Error::Kind::input, std::move(where), std::move(message));
}

void throw_input_error(std::string_view file, std::string message) {
  throw_input_error(SourcePosition{.file = std::string(file), .pointer = {}, .excerpt = {}}, std::move(message));
}

void throw_failure(std::string_view file, std::string message) {
  throw Error(Error::Kind::failure, SourcePosition{.file = std::string(file), .pointer = {}, .excerpt = {}},
              std::move(message));
}

std::string nearest_name(std::string_view name, std::span<const std::string> candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < best_distance && distance < candidate.size()) best = candidate, best_distance = distance;
  }
  return best;
}

std::string suggestion(std::string_view name, std::span<const std::string> candidates) {
  if (const std::string nearest = nearest_name(name, candidates); !nearest.empty())
    return fmt::format("; did you mean \"{}\"?", nearest);
  return fmt::format("; known: {}", fmt::join(candidates, ", "));
}

}  // namespace gradslc
