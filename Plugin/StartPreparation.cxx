#include "StartPreparation.h"

#include "vtkLogger.h"
#include "vtkProcessModule.h"

#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#ifdef TYNDALL_WITH_WINDOW
#include <QApplication>
#endif

namespace
{
bool HasWindow()
{
#ifdef TYNDALL_WITH_WINDOW
  return qobject_cast<QApplication*>(QCoreApplication::instance()) != nullptr;
#else
  return false;
#endif
}

bool IsWanted()
{
  const char* said = std::getenv("TYNDALL_PREPARE");
  vtkProcessModule* process = vtkProcessModule::GetProcessModule();
  if ((said && std::strcmp(said, "0") == 0) || !process)
  {
    return false;
  }
  const vtkProcessModule::ProcessTypes type = vtkProcessModule::GetProcessType();
  const bool isServer = type == vtkProcessModule::PROCESS_SERVER || type == vtkProcessModule::PROCESS_DATA_SERVER;
  return HasWindow() || (isServer && process->GetPartitionId() == 0);
}

std::string Program()
{
  Dl_info plugin = {};
  const bool found = dladdr(reinterpret_cast<const void*>(&StartPreparation), &plugin) != 0;
  const std::string file = found ? plugin.dli_fname : "";
  return file.substr(0, file.rfind('/') + 1) + "TyndallPreparation";
}
}

void StartPreparation()
{
  static bool started = false;
  if (started || !IsWanted())
  {
    return;
  }
  started = true;
  std::string program = Program(), count = "1000", parent = std::to_string(getpid());
  char* const arguments[] = { program.data(), count.data(), parent.data(), nullptr };
  pid_t process = 0;
  if (posix_spawn(&process, program.c_str(), nullptr, nullptr, arguments, environ) != 0)
  {
    vtkLogF(TRACE, "%s cannot be started", program.c_str());
    return;
  }
  vtkLogF(TRACE, "%s is process %d", program.c_str(), static_cast<int>(process));
  // Waits for the process to end, so that no zombie is left.
  std::thread([process] { waitpid(process, nullptr, 0); }).detach();
}
