#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace gradslc {
namespace {

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
    const std::string margin = fmt::format("{:5} | ", where.line);
    text += "\n" + margin + where.excerpt;
    if (where.column > 0) text += fmt::format("\n{:>{}}^", "", margin.size() + static_cast<std::size_t>(where.column) - 1);
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
