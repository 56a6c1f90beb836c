#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

/// One line of a table, its cells by the names of their columns.
class ReferenceRow
{
public:
  /// @param place  file and line, for complaints
  ReferenceRow(std::string place, std::map<std::string, std::string> cells)
    : Place(std::move(place))
    , Cells(std::move(cells))
  {
  }

  /// @throws std::runtime_error where there is no such column
  const std::string& Text(const std::string& column) const;

  /// @throws std::runtime_error where there is no such column, or what stands there is not a number
  double operator[](const std::string& column) const;

private:
  std::string Place;
  std::map<std::string, std::string> Cells;
};

/// Reads a .csv: lines that begin with # describe it, the first other one names the columns, each further one is a row.
/// @throws std::runtime_error where the file cannot be read, has no rows, or a row has other cells than the head
std::vector<ReferenceRow> ReadTable(const std::string& file);

/// Reads Data/Reference/NAME.csv.
std::vector<ReferenceRow> ReadReference(const std::string& name);

/// The row of Data/Reference/NAME.csv in which columns have these numbers.
/// @throws std::runtime_error where there is none, or more than one
ReferenceRow ReferenceRowWhere(
  const std::string& name, std::initializer_list<std::pair<const char*, double>> columnsAndNumbers);
