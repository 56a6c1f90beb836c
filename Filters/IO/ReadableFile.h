#pragma once

#include <cstdint>
#include <string>

namespace tyndall
{
/// Whether what has that name, if anything, is not a pipe, a socket or a device: who opens these may wait for ever.
bool HasAnEnd(const std::string& path);

/// Bytes of a file that is to be read.
/// @throws InvalidInput where it is not there, may not be read, is a folder, or has no end, as a pipe
std::uint64_t ReadableSize(const std::string& path);
}
