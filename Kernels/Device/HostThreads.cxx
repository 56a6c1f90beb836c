#include "Device/HostThreads.h"

#include <algorithm>
#include <exception>
#include <numeric>
#include <system_error>
#include <thread>
#include <vector>

namespace tyndall
{
namespace
{
constexpr std::size_t ThreadsAtMost = 16; ///< largest number of threads; 16 cores use the full bandwidth of any memory
}

void InThreads(std::size_t count, std::size_t least, const std::function<void(std::size_t, std::size_t)>& work)
{
  const std::size_t cores = std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, ThreadsAtMost);
  const std::size_t parts = std::clamp<std::size_t>(count / std::max<std::size_t>(least, 1), 1, cores);
  const auto beginOf = [&](std::size_t part) { return count / parts * part + std::min(part, count % parts); };
  std::vector<std::exception_ptr> failures(parts);
  const auto run = [&](std::size_t part) {
    try
    {
      work(beginOf(part), beginOf(part + 1));
    }
    catch (...)
    {
      failures[part] = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  others.reserve(parts);
  for (std::size_t part = 1; part < parts; ++part)
  {
    try
    {
      others.emplace_back(run, part);
    }
    catch (const std::system_error&) // no thread can be created: the calling thread processes this range
    {
      run(part);
    }
  }
  run(0);
  for (std::thread& other : others)
  {
    other.join();
  }
  for (const std::exception_ptr& failure : failures)
  {
    if (failure)
    {
      std::rethrow_exception(failure);
    }
  }
}

double SumInThreads(std::size_t count, std::size_t piece, const std::function<double(std::size_t, std::size_t)>& term)
{
  std::vector<double> sums((count + piece - 1) / piece, 0.0);
  InThreads(sums.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
    {
      sums[k] = term(k * piece, std::min((k + 1) * piece, count));
    }
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}
}
