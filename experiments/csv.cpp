#include "experiments/csv.h"

namespace gradslc {

std::vector<CsvRecord> parse_csv(std::string_view text) {
  std::vector<CsvRecord> records;
  CsvRecord record{{""}, 1};
  int line = 1;
  bool quoted = false, begun = false;
  const auto end_record = [&] {
    if (begun) records.push_back(std::move(record));
    record = {{""}, line};
    begun = false;
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') ++line;
    if (quoted) {
      if (c != '"') {
        record.fields.back() += c;
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        record.fields.back() += text[++i];
      } else {
        quoted = false;
      }
    } else if (c == '\n') {
      end_record();
    } else if (c != '\r') {
      begun = true;
      if (c == '"') {
        quoted = true;
      } else if (c == ',') {
        record.fields.emplace_back();
      } else {
        record.fields.back() += c;
      }
    }
  }
  end_record();
  return records;
}

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace gradslc
