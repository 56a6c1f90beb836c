#pragma once

#include <charconv>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

// Conversion of numbers to text and back, independent of the locale: a host program may have set a locale with a
// decimal comma. No other source converts floating-point numbers (the test NumbersKnowNoLocale checks this).

namespace tyndall
{
/// Converts a number to text, for users, files and kernels.
/// @param format  printf format for one double: "%g", "%.3g", "%.0f", "%.8e"
inline std::string Text(const char* format, double value)
{
  const char kind = format[std::strlen(format) - 1];
  int precision = 6;
  if (format[1] == '.')
  {
    std::from_chars(format + 2, format + std::strlen(format) - 1, precision);
  }
  char text[512]; // large enough: the largest double has 309 digits before the decimal point
  const auto written = std::to_chars(text, text + sizeof(text), value,
    kind == 'f'     ? std::chars_format::fixed
      : kind == 'e' ? std::chars_format::scientific
                    : std::chars_format::general,
    precision);
  return { text, written.ptr };
}

/// A float as literal of C++ and OpenCL C, with all digits.
inline std::string FloatLiteral(float value)
{
  return Text("%.8e", value) + "f";
}

/// Floating-point number at the start of a text, after blanks. Empty if there is none, or if it is beyond the range of
/// doubles.
inline std::optional<double> NumberIn(std::string_view text)
{
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  text.remove_prefix(begin == std::string_view::npos ? text.size() : begin);
  text.remove_prefix(text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0);
  double number = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  return read.ec == std::errc() ? std::optional<double>(number) : std::nullopt;
}
}
