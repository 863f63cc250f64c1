// Values printed in the papers, as small CSV files in benchmarks/reference: '#' begins a line about the
// source, then a header, then rows. Names keep their unit; numbers stay in the file's unit.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace enc::bench {

class Reference {
 public:
  // `models`: the models folder, which stands beside benchmarks. Throws Error with the place of the error.
  static Reference load(const std::string& models, const std::string& name);
  static Reference parse(std::string_view text, const std::string& name);

  [[nodiscard]] std::size_t rows() const { return cells_.size(); }
  [[nodiscard]] const std::string& source() const { return source_; }  // the lines about the source
  [[nodiscard]] const std::string& text(std::size_t row, std::string_view column) const;
  [[nodiscard]] double number(std::size_t row, std::string_view column) const;
  // The row in which each given column has the given text; throws if there is no such row.
  struct CellMatch {
    std::string_view column, is;
  };
  [[nodiscard]] std::size_t row(const std::vector<CellMatch>& where) const;

 private:
  std::string name_, source_;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> cells_;
};

}  // namespace enc::bench
