#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/error.h"

namespace gradslc {

/// What is wrong with an input, collected so that one run reports everything instead of the first slip.
class Problems {
 public:
  void add(SourcePosition where, std::string message) {
    errors_.emplace_back(Error::Kind::input, std::move(where), std::move(message));
  }
  bool empty() const { return errors_.empty(); }
  /// In the order in which they were found.
  const std::vector<Error>& all() const { return errors_; }

 private:
  std::vector<Error> errors_;
};

}  // namespace gradslc
