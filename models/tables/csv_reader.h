// Comma-separated tables with a header: columns are found by name, and each fault is reported with its place.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace enc::models {

class CsvReader {
 public:
  // name: of the file, for messages "name:line:column: ...". The text must outlive the reader.
  CsvReader(std::string_view text, std::string name);

  // Reads up to and including the header; comments (#) and empty lines may come before it. Columns are then
  // known by their index in `needed` followed by `optional`; others are ignored. Throws Error.
  void header(const std::vector<std::string_view>& needed,
              const std::vector<std::string_view>& optional = {});
  [[nodiscard]] const std::string& remark() const { return remark_; }  // the comments before the header

  // The next row that is not empty; false at the end. Throws Error if its number of cells differs from the
  // header's.
  bool next();
  [[nodiscard]] std::size_t line() const { return line_; }  // line of the row, from 1
  [[nodiscard]] bool has(std::size_t column) const { return at_[column] < columns_; }
  [[nodiscard]] std::string_view text(std::size_t column) const;  // "" if the column is missing
  // Throws Error unless it is a finite number.
  [[nodiscard]] double number(std::size_t column) const;

  [[noreturn]] void fail(std::size_t column, const std::string& what) const;  // fails at a cell of this row
  [[noreturn]] void fail_line(const std::string& what) const;                 // fails at this row
  [[noreturn]] void fail_line(std::size_t line, const std::string& what) const;

 private:
  struct Cell {
    std::string_view text;
    std::size_t place = 1;  // counts from 1, as editors do
  };
  bool next_line(std::string_view& line);
  void split(std::string_view line);
  std::size_t find(std::string_view column, bool needed) const;
  [[noreturn]] void fail_at(std::size_t line, std::size_t place, const std::string& what) const;

  std::string_view text_;
  std::string name_, remark_, wanted_;
  std::vector<std::string_view> names_;
  std::vector<std::size_t> at_;  // place of each known column among the cells
  std::vector<Cell> cells_;
  std::size_t line_ = 0, columns_ = 0;
};

// The line that header() would read; empty if there is no such line.
[[nodiscard]] std::string_view csv_header(std::string_view text);

// The whole file. Throws Error "path:1:1: cannot read this <kind>; expected <wanted>; check the name".
[[nodiscard]] std::string csv_text(const std::string& path, const std::string& kind,
                                   const std::string& wanted);

}  // namespace enc::models
