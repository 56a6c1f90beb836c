#include "PreparedScenes.h"

#include "Device/PoclCache.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <new>
#include <stdexcept>
#include <string>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
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

/// Scenes shared by two processes: each process takes the next scene that none has taken. Threads cannot replace
/// processes, because OpenCL compilers hold a lock, and the threads of a process would compile one after another.
class ScenesInTurn
{
public:
  explicit ScenesInTurn(int count)
    : Count(count)
    , Next(static_cast<std::atomic<int>*>(
        mmap(nullptr, sizeof(std::atomic<int>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)))
  {
    if (this->Next == MAP_FAILED)
    {
      throw std::runtime_error("there is no memory that two processes share");
    }
    new (this->Next) std::atomic<int>(0);
  }

  /// Prepares scenes until all are taken.
  /// @return whether this process prepared its scenes without an error
  bool PrepareThem() noexcept
  {
    bool prepared = true;
    for (int scene = (*this->Next)++; scene < this->Count; scene = (*this->Next)++)
    {
      prepared = PrepareScene(scene) && prepared;
    }
    return prepared;
  }

private:
  int Count;
  std::atomic<int>* Next;
};

/// Ends this process when its parent process ends.
void EndWith(pid_t parent)
{
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) // the parent has already ended
  {
    std::_Exit(0);
  }
}
}

int main(int argc, char* argv[])
{
  if (argc > 2)
  {
    setpriority(PRIO_PROCESS, 0, 19);
    EndWith(static_cast<pid_t>(std::atol(argv[2])));
  }
  try
  {
    const Note note = NoteOfAll();
    const int all = PreparedSceneCount(), wanted = argc > 1 ? std::atoi(argv[1]) : all;
    if (note.IsThere())
    {
      return 0;
    }
    ScenesInTurn scenes(std::min(wanted, all));
    const pid_t self = getpid(), helper = wanted > 1 ? fork() : -1;
    if (helper == 0)
    {
      EndWith(self);
      // _Exit does not run the destructors of libraries' static objects, which would wait for threads that fork() does
      // not copy.
      std::_Exit(scenes.PrepareThem() ? 0 : 1);
    }
    bool prepared = scenes.PrepareThem();
    if (helper > 0)
    {
      int status = 0;
      prepared = waitpid(helper, &status, 0) == helper && status == 0 && prepared;
    }
    if (prepared && wanted >= all)
    {
      note.Write();
    }
    return prepared ? 0 : 1;
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
