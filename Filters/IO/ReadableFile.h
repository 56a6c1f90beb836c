#pragma once

#include <cstdint>
#include <string>

namespace tyndall
{
/// Bytes of a file that is to be read.
/// @throws InvalidInput where it is not there, may not be read, or is a folder
std::uint64_t ReadableSize(const std::string& path);
}
