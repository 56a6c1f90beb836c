#include "StressWorker.h"

#include "Measure.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace bench
{
namespace
{
/// A child and the pipe on which it writes a line for each piece of work that it has done.
class Child
{
public:
  explicit Child(const std::function<void(std::FILE*)>& work)
  {
    int ends[2];
    std::fflush(nullptr); // or the child would print it again
    if (pipe(ends) != 0 || (this->Process = fork()) < 0)
    {
      throw std::runtime_error("No process could be started.");
    }
    if (this->Process == 0)
    {
      close(ends[0]);
      std::FILE* const lines = fdopen(ends[1], "w");
      work(lines);
      std::fflush(nullptr);
      _Exit(EXIT_SUCCESS); // no destructors: OpenCL's threads may be at work
    }
    close(ends[1]);
    this->Lines = ends[0];
  }

  ~Child()
  {
    kill(this->Process, SIGKILL);
    this->Wait();
    close(this->Lines);
  }

  /// The next line, or how the child ended without one.
  bool NextLine(double seconds, std::string& line, std::string& death)
  {
    const double end = WallSeconds() + seconds;
    line.clear();
    for (char c = 0; c != '\n';)
    {
      pollfd waiting = { this->Lines, POLLIN, 0 };
      const int left = static_cast<int>(1e3 * (end - WallSeconds()));
      const int ready = poll(&waiting, 1, left > 0 ? left : 0);
      if (ready == 0)
      {
        death = "hung: not done after " + std::to_string(static_cast<int>(seconds)) + " s";
        return false;
      }
      if (ready < 0 && errno == EINTR)
      {
        continue;
      }
      if (read(this->Lines, &c, 1) != 1)
      {
        const int status = this->Wait();
        death = WIFSIGNALED(status) ? "crashed: signal " + std::to_string(WTERMSIG(status))
                                    : "ended with status " + std::to_string(WEXITSTATUS(status));
        return false;
      }
      line += c == '\n' ? "" : std::string(1, c);
    }
    return true;
  }

private:
  int Wait()
  {
    if (!this->Ended)
    {
      waitpid(this->Process, &this->Status, 0);
      this->Ended = true;
    }
    return this->Status;
  }

  pid_t Process = 0;
  int Lines = -1;
  int Status = 0;
  bool Ended = false;
};
}

int RunApart(const std::function<int()>& work, double seconds)
{
  Child child([&](std::FILE* lines) { std::fprintf(lines, "%d\n", work()); });
  std::string line, death;
  return child.NextLine(seconds, line, death) ? std::atoi(line.c_str()) : -1;
}

std::vector<std::string> RunAllApart(std::size_t count, double seconds,
  const std::function<std::string(std::size_t)>& work,
  const std::function<void(std::size_t, const std::string&)>& buried)
{
  std::vector<std::string> words;
  while (words.size() < count)
  {
    Child child([&](std::FILE* lines) {
      for (std::size_t i = words.size(); i < count; ++i)
      {
        std::fprintf(lines, "%s\n", work(i).c_str());
        std::fflush(lines);
      }
    });
    std::string word, death;
    while (words.size() < count && child.NextLine(seconds, word, death))
    {
      words.push_back(word);
    }
    if (words.size() < count)
    {
      buried(words.size(), death);
      words.emplace_back("WRONG");
    }
  }
  return words;
}
}
