#pragma once

#include <string>
#include <vector>

/// How benchmarks print: figures as one JSON object a line, and tables for people, whose lines never begin with a
/// brace.
namespace bench
{
class JsonLine
{
public:
  JsonLine& Add(const char* key, const std::string& value);
  JsonLine& Add(const char* key, double value); ///< what is not a number is left out
  void Print() const;

private:
  std::string Text;
};

/// printf's format with one number; "-" where it is not one.
std::string Text(const char* format, double value);

std::string GridText(int edge); ///< of a cube: "64x64x64"

/// Columns as wide as they need to be, the first two to the left.
class Table
{
public:
  explicit Table(std::vector<std::string> headings)
    : Rows{ std::move(headings) }
  {
  }
  void Add(std::vector<std::string> row) { this->Rows.push_back(std::move(row)); }
  void Print(const std::string& title) const;

private:
  std::vector<std::vector<std::string>> Rows;
};
}
