#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gradslc {

/// One record of a CSV file (RFC 4180) with the line that it begins in, from 1.
struct CsvRecord {
  std::vector<std::string> fields;
  int line = 0;
};

/// All records of a text; lines may end with LF or CRLF, quoted fields may hold commas, quotes and line ends.
std::vector<CsvRecord> parse_csv(std::string_view text);

/// The field as it must be written: in quotes where it needs them.
std::string csv_field(std::string_view text);

}  // namespace gradslc
