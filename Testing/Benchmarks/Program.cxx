#include "Program.h"

#include "Device/Errors.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>

namespace bench
{
int RunOnDevice(int argc, char* argv[], const std::function<void(tyndall::Device&, const Arguments&)>& work)
{
  const Arguments arguments = ReadArguments(argc, argv);
  std::shared_ptr<tyndall::Device> device;
  try
  {
    device = tyndall::Device::Find();
  }
  catch (const tyndall::DeviceError& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return std::getenv("TYNDALL_REQUIRE_DEVICE") ? EXIT_FAILURE : 125;
  }
  try
  {
    work(*device, arguments);
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
}
}
