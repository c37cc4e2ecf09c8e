// Reads the columns it needs of a .ctraj file. Not by the library's own reader: the double stands on nothing that it is
// there to test.
#include <algorithm>
#include <fstream>
#include <locale>
#include <sstream>
#include <stdexcept>

#include "fakehd_script.hpp"

namespace fakehd {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

class Columns {
 public:
  explicit Columns(const std::string& line) : names_(split(line)) {}

  bool has(const char* name) const { return index(name) < names_.size(); }

  double value(const std::vector<std::string>& cells, const char* name) const {
    const std::size_t at = index(name);
    if (at >= cells.size()) throw std::runtime_error(std::string("trajectory: a row without ") + name);
    std::istringstream in(cells[at]);
    in.imbue(std::locale::classic());
    double number = 0;
    if (!(in >> number)) throw std::runtime_error("trajectory: '" + cells[at] + "' is no number");
    return number;
  }

 private:
  std::size_t index(const char* name) const {
    return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  }

  std::vector<std::string> names_;
};

Row read_row(const Columns& columns, const std::string& line) {
  const std::vector<std::string> cells = split(line);
  Row row;
  row.t = columns.value(cells, "t");
  row.at = {columns.value(cells, "px"), columns.value(cells, "py"), columns.value(cells, "pz")};
  if (columns.has("qx")) {
    row.turn = {columns.value(cells, "qx"), columns.value(cells, "qy"), columns.value(cells, "qz"),
                columns.value(cells, "qw")};
  }
  if (columns.has("buttons")) row.buttons = static_cast<unsigned>(columns.value(cells, "buttons"));
  return row;
}

}  // namespace

std::vector<Row> read_trajectory(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read the trajectory " + path);
  std::string line;
  while (std::getline(file, line) && line.starts_with('#')) {
  }
  const Columns columns(line);
  std::vector<Row> rows;
  while (std::getline(file, line) && !line.starts_with('#')) {
    rows.push_back(read_row(columns, line));
    if (rows.size() > 1 && rows.back().t <= rows[rows.size() - 2].t) {
      throw std::runtime_error("trajectory: time must increase");
    }
  }
  if (rows.empty()) throw std::runtime_error("the trajectory " + path + " has no row");
  const double start = rows.front().t;
  for (Row& row : rows) row.t -= start;
  return rows;
}

}  // namespace fakehd
