#include "PreparedScenes.h"

#include "Device/PoclCache.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

// Solves and renders small scenes, so that the cache of OpenCL's compiler contains the kernels that the first solve in
// ParaView needs:
//
//     TyndallPreparation [COUNT [PARENT]]
//
// COUNT: number of scenes, most likely first; default: all. PARENT: a process id; the program ends when that process
// does. If all scenes were prepared before with the same library and cache, the program does nothing. Exit status 1 if
// a filter reports an error.

namespace
{
/// Record of the scenes that have been prepared. Its file is in the cache of OpenCL's compiler, so that both are
/// deleted together.
struct Note
{
  std::string file, content;

  bool IsThere() const
  {
    std::ifstream found(this->file);
    return std::string(std::istreambuf_iterator<char>(found), {}) == this->content;
  }
  void Write() const { std::ofstream(this->file) << this->content; }
};

Note NoteOfAll()
{
  const char* device = std::getenv("TYNDALL_DEVICE");
  return { tyndall::PreparePocl().folder + "/tyndall-prepared", LibraryVersion() + (device ? device : "") + "\n" };
}

/// Sets the lowest priority for this process, and ends it when the parent process ends.
void ServeParent(pid_t parent)
{
  setpriority(PRIO_PROCESS, 0, 19);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) // the parent has already ended
  {
    std::exit(0);
  }
}
}

int main(int argc, char* argv[])
{
  if (argc > 2)
  {
    ServeParent(static_cast<pid_t>(std::atol(argv[2])));
  }
  try
  {
    const Note note = NoteOfAll();
    const int all = PreparedSceneCount(), wanted = argc > 1 ? std::atoi(argv[1]) : all;
    for (int scene = 0; scene < std::min(wanted, all) && !note.IsThere(); ++scene)
    {
      if (!PrepareScene(scene))
      {
        return 1;
      }
      if (scene + 1 == all)
      {
        note.Write();
      }
    }
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
