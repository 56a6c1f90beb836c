#include "SlabPeers.h"

#include <cstdio>
#include <fstream>
#include <sstream>

namespace bench
{
std::vector<PeerAnswer> AskPeers(const std::vector<PeerCase>& cases)
{
  const std::string folder = TYNDALL_PEERS_FOLDER;
  const std::string file = folder + ".cases";
  {
    std::ofstream stream(file);
    for (const PeerCase& asked : cases)
    {
      stream << asked.tau << ' ' << asked.albedo << ' ' << asked.g << ' ' << asked.light << '\n';
    }
  }
  std::vector<PeerAnswer> answers;
  const std::string command = "python3 '" TYNDALL_PEERS_SCRIPT "' '" + folder + "' < '" + file + "'";
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (!pipe)
  {
    std::fprintf(stderr, "Without other people's programs: %s cannot be run\n", command.c_str());
    return answers;
  }
  char line[200];
  while (std::fgets(line, sizeof(line), pipe))
  {
    std::istringstream words(line);
    std::string version;
    PeerAnswer answer;
    if (words >> answer.program >> version >> answer.number >> answer.reflectance >> answer.transmittance >>
        answer.seconds &&
      answer.number < cases.size())
    {
      answer.program += ' ' + version;
      answers.push_back(answer);
    }
  }
  pclose(pipe);
  return answers;
}
}
