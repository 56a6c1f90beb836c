#include "Arguments.h"

#include <algorithm>
#include <cstdlib>

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
}
