#include "Report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bench
{
JsonLine& JsonLine::Add(const char* key, const std::string& value)
{
  this->Text += this->Text.empty() ? "{" : ", ";
  this->Text += '"' + std::string(key) + "\": \"";
  for (const char c : value)
  {
    const bool special = c == '"' || c == '\\';
    const bool control = static_cast<unsigned char>(c) < ' ';
    this->Text += special ? std::string{ '\\', c } : std::string{ control ? ' ' : c };
  }
  this->Text += '"';
  return *this;
}

JsonLine& JsonLine::Add(const char* key, double value)
{
  if (std::isfinite(value))
  {
    this->Text += this->Text.empty() ? "{" : ", ";
    this->Text += '"' + std::string(key) +
      "\": " + bench::Text(std::abs(value) < 1e15 && value == std::floor(value) ? "%.0f" : "%.5g", value);
  }
  return *this;
}

void JsonLine::Print() const
{
  std::printf("%s}\n", this->Text.c_str());
  std::fflush(stdout);
}

std::string Text(const char* format, double value)
{
  char text[64];
  std::snprintf(text, sizeof(text), format, value);
  return std::isfinite(value) ? text : "-";
}

std::string GridText(int edge)
{
  const std::string text = std::to_string(edge);
  return text + "x" + text + "x" + text;
}

void Table::Print(const std::string& title) const
{
  std::vector<std::size_t> widths;
  for (const std::vector<std::string>& row : this->Rows)
  {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i)
    {
      widths[i] = std::max(widths[i], row[i].size());
    }
  }
  std::printf("\n%s\n", title.c_str());
  for (const std::vector<std::string>& row : this->Rows)
  {
    for (std::size_t i = 0; i < row.size(); ++i)
    {
      std::printf(i < 2 ? "  %-*s" : "  %*s", static_cast<int>(widths[i]), row[i].c_str());
    }
    std::printf("\n");
  }
  std::fflush(stdout);
}
}
