#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

/// Work that may crash or hang, in processes of their own. POSIX.
namespace bench
{
/// Runs `work` in a child.
/// @return what it returned; -1 where it crashed or took longer than `seconds`
int RunApart(const std::function<int()>& work, double seconds);

/// Runs `work(i)` for 0 <= i < count, one after the other in a child, which goes on with the next number in a new one
/// where it crashes or one number takes longer than `seconds`.
/// @param work   prints what it likes, and returns a word
/// @param buried told of each number that its process did not survive, and how it ended
/// @return the words; "WRONG" where there is none
std::vector<std::string> RunAllApart(std::size_t count, double seconds,
  const std::function<std::string(std::size_t)>& work,
  const std::function<void(std::size_t, const std::string&)>& buried);
}
