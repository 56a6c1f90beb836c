#include "Program.h"

#include "Device/Errors.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>

namespace bench
{
bool Arguments::Asks(const std::string& word) const
{
  return this->words.empty() || std::find(this->words.begin(), this->words.end(), word) != this->words.end();
}

Arguments ReadArguments(int argc, char* argv[])
{
  Arguments arguments;
  arguments.quick = std::getenv("TYNDALL_BENCH_QUICK") != nullptr;
  for (int i = 1; i < argc; ++i)
  {
    const std::string word = argv[i];
    if (word == "--quick")
    {
      arguments.quick = true;
    }
    else
    {
      arguments.words.push_back(word);
    }
  }
  return arguments;
}

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
