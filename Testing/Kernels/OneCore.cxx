#include "OneCore.h"

#include <filesystem>
#include <string>

#include <fcntl.h>
#include <sched.h>
#include <sys/file.h>
#include <unistd.h>

namespace
{
/// @return whether it was free; it is this process's until that ends
bool Take(int core)
{
  const std::string name = "/tyndall_tests_core_" + std::to_string(core) + "_of_" + std::to_string(getuid());
  const int file =
    open((std::filesystem::temp_directory_path().string() + name).c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
  return file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0;
}

int FreeCore()
{
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof(allowed), &allowed) != 0)
  {
    return -1;
  }
  for (int core = 0; core < CPU_SETSIZE; ++core)
  {
    if (CPU_ISSET(core, &allowed) && Take(core))
    {
      return core;
    }
  }
  return -1;
}
}

void KeepToOneCore()
{
  static const int core = FreeCore();
  static bool kept = core < 0;
  if (kept)
  {
    return;
  }
  kept = true;
  cpu_set_t own;
  CPU_ZERO(&own);
  CPU_SET(core, &own);
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task"))
  {
    sched_setaffinity(std::stoi(thread.path().filename().string()), sizeof(own), &own);
  }
}
