#include "Reference/ReferenceTable.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace
{
/// An empty cell after the last comma counts.
std::vector<std::string> CellsOf(const std::string& line)
{
  std::vector<std::string> cells(1);
  for (const char letter : line)
  {
    if (letter == ',')
    {
      cells.emplace_back();
    }
    else if (letter != '\r')
    {
      cells.back() += letter;
    }
  }
  return cells;
}

std::string FileOf(const std::string& name)
{
  return std::string(TYNDALL_REFERENCE_DATA) + "/" + name + ".csv";
}
}

const std::string& ReferenceRow::Text(const std::string& column) const
{
  const auto cell = this->Cells.find(column);
  if (cell == this->Cells.end())
  {
    throw std::runtime_error(this->Place + ": there is no column " + column);
  }
  return cell->second;
}

double ReferenceRow::operator[](const std::string& column) const
{
  const std::string& text = this->Text(column);
  const char* end = text.data() + text.size();
  double number = 0.0;
  // What strtod reads depends on the locale, this does not.
  const std::from_chars_result result = std::from_chars(text.data(), end, number);
  if (result.ec != std::errc() || result.ptr != end)
  {
    throw std::runtime_error(this->Place + ", column " + column + ": '" + text + "' is not a number");
  }
  return number;
}

std::vector<ReferenceRow> ReadTable(const std::string& file)
{
  std::ifstream stream(file);
  if (!stream)
  {
    throw std::runtime_error(file + " cannot be read");
  }
  std::vector<std::string> head;
  std::vector<ReferenceRow> rows;
  int number = 0;
  for (std::string line; std::getline(stream, line);)
  {
    ++number;
    if (line.empty() || line[0] == '#')
    {
      continue;
    }
    const std::vector<std::string> cells = CellsOf(line);
    if (head.empty())
    {
      head = cells;
      continue;
    }
    const std::string place = file + ", line " + std::to_string(number);
    if (cells.size() != head.size())
    {
      throw std::runtime_error(
        place + " has " + std::to_string(cells.size()) + " cells, the head " + std::to_string(head.size()));
    }
    std::map<std::string, std::string> named;
    for (std::size_t i = 0; i < head.size(); ++i)
    {
      named[head[i]] = cells[i];
    }
    rows.emplace_back(place, std::move(named));
  }
  if (rows.empty())
  {
    throw std::runtime_error(file + " has no rows");
  }
  return rows;
}

std::vector<ReferenceRow> ReadReference(const std::string& name)
{
  return ReadTable(FileOf(name));
}

ReferenceRow ReferenceRowWhere(
  const std::string& name, std::initializer_list<std::pair<const char*, double>> columnsAndNumbers)
{
  std::vector<ReferenceRow> found;
  for (const ReferenceRow& row : ReadReference(name))
  {
    if (std::all_of(columnsAndNumbers.begin(), columnsAndNumbers.end(),
          [&](const auto& asked) { return row[asked.first] == asked.second; }))
    {
      found.push_back(row);
    }
  }
  if (found.size() != 1)
  {
    std::string asked;
    for (const auto& [column, value] : columnsAndNumbers)
    {
      char text[100];
      std::snprintf(text, sizeof(text), " %s %.17g", column, value);
      asked += text;
    }
    throw std::runtime_error(FileOf(name) + " has " + std::to_string(found.size()) + " rows with" + asked);
  }
  return found.front();
}
