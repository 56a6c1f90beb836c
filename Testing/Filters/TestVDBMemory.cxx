#include "TestSupport.h"
#include "VDBScene.h"

#include "vtkNew.h"
#include "vtkVDBReader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <random>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

using test::Path;
using test::ReadBytes;

/// What a .vdb file makes the reader take, measured in a child process for each file. The parent reads none: OpenVDB's
/// threads would not survive a fork.
namespace
{
constexpr double Mebibyte = 1048576.0;

/// Runs something in a child process.
/// @return what it returns, and the memory that it took beyond that of the parent, MiB
struct Outcome
{
  int Code = -1;
  double Memory = 0.0;
};
Outcome InChild(const std::function<int()>& act)
{
  std::cout.flush();
  struct rusage own = {}, childs = {};
  getrusage(RUSAGE_SELF, &own);
  const pid_t child = fork();
  if (child == 0)
  {
    struct rlimit most = { 5ul << 30, 5ul << 30 }; // for the machine's sake
    setrlimit(RLIMIT_AS, &most);
    _exit(act());
  }
  int status = 0;
  wait4(child, &status, 0, &childs);
  return { WIFEXITED(status) ? WEXITSTATUS(status) : -1,
    static_cast<double>(childs.ru_maxrss - own.ru_maxrss) / 1024.0 };
}

/// 0: read, 1: one error and no data, 2: something else.
int ReadFile(const std::string& path, const char* part, vtkIdType maximum = 0)
{
  vtkNew<vtkVDBReader> reader;
  test::Errors errors(reader);
  reader->SetFileName(path.c_str());
  reader->SetMaximumMemory(maximum);
  reader->Update();
  if (errors.None())
  {
    return 0;
  }
  return errors.WasOneWith(part) && test::IsEmpty(reader->GetOutput()) ? 1 : 2;
}

/// A cloud of 40^3 voxels of noise, far from the origin: a root corner that is found again in the file.
constexpr std::array<std::int32_t, 3> Corner = { 4096, -8192, 12288 };

void WriteCloud(const std::string& path, std::uint32_t compression)
{
  auto fog = test::NewGrid<openvdb::FloatGrid>("float", "density");
  auto flow = test::NewGrid<openvdb::Vec3SGrid>("vec3s", "flow");
  std::mt19937 random(3);
  for (int i = 0; i < 40 * 40 * 40; ++i)
  {
    const openvdb::Coord at(Corner[0] + 100 + i % 40, Corner[1] + i / 40 % 40, Corner[2] + i / 1600);
    const float value = static_cast<float>(random() % 100) * 0.01f;
    if (random() % 3 == 0)
    {
      fog->tree().setValue(at, value);
    }
    if (i % 1000 == 0)
    {
      flow->tree().setValue(at, openvdb::Vec3s(value));
    }
  }
  openvdb::io::File file(path);
  file.setCompression(compression);
  file.write({ fog, flow });
  file.close();
}

/// Where the bytes are that say where voxels lie: corners of the roots, and the masks behind them.
std::vector<std::size_t> PlacesOfCorners(const std::string& bytes)
{
  std::vector<std::size_t> places;
  for (std::size_t at = 0; at + sizeof(Corner) <= bytes.size(); ++at)
  {
    if (std::memcmp(&bytes[at], Corner.data(), sizeof(Corner)) == 0)
    {
      places.push_back(at);
    }
  }
  return places;
}

template <typename T>
void Put(std::string& bytes, std::size_t at, T value)
{
  if (at + sizeof(T) <= bytes.size())
  {
    std::memcpy(&bytes[at], &value, sizeof(T));
  }
}

/// One of seven kinds of damage.
std::string Mutation(const std::string& whole, const std::vector<std::size_t>& corners, int kind, std::mt19937& random)
{
  std::string bytes = whole;
  const std::size_t anywhere = random() % bytes.size(), corner = corners[random() % corners.size()];
  const std::int32_t extreme[] = { 0, 1, -1, INT32_MAX, INT32_MIN, 1 << 16, 1 << 24 };
  switch (kind)
  {
    case 0: bytes[anywhere] ^= static_cast<char>(1 << random() % 8); break;
    case 1: Put(bytes, anywhere, static_cast<std::int64_t>(extreme[random() % 7])); break;
    case 2: Put(bytes, anywhere, extreme[random() % 7]); break;
    case 3:
      Put(bytes, random() % corners[0], extreme[random() % 7]);
      break; // counts, lengths and offsets before the tree
    case 4:  // a root elsewhere
      Put(bytes, corner + 4 * (random() % 3), static_cast<std::int32_t>(random() % 1000) * 4096 - 2000000);
      break;
    case 5: // bits of the masks of the root's children: nodes and tiles that are not there, or elsewhere
      bytes[corner + 12 + random() % 8192] ^= static_cast<char>(1 << random() % 8);
      break;
    default: // a leaf's corner moves with its bit: swap two bytes of the mask of children
      std::swap(bytes[corner + 12 + random() % 4096], bytes[corner + 12 + random() % 4096]);
  }
  return bytes;
}

/// Reads mutations of one kind, in one process.
/// @return how many of them are errors; 99: one is something else
int ReadMutations(const std::string& whole, int kind, int count, unsigned seed)
{
  std::mt19937 random(seed);
  const auto corners = PlacesOfCorners(whole);
  int errors = 0;
  for (int i = 0; i < count; ++i)
  {
    test::WriteBytes(Path("mutated.vdb"), Mutation(whole, corners, kind, random));
    const int result = ReadFile(Path("mutated.vdb"), "mutated.vdb");
    if (result == 2)
    {
      return 99;
    }
    errors += result;
  }
  return errors;
}

void NoMutationTakesMemory(test::Claims& claims)
{
  constexpr int kinds = 7, rounds = 5, atOnce = 20;
  std::array<double, kinds> worst = {};
  int files = 0, errors = 0;
  bool allHeld = true;
  unsigned seed = 20261122;
  for (const std::uint32_t compression : { std::uint32_t(openvdb::io::COMPRESS_NONE),
         std::uint32_t(openvdb::io::COMPRESS_ACTIVE_MASK | openvdb::io::COMPRESS_ZIP),
         std::uint32_t(openvdb::io::COMPRESS_ACTIVE_MASK | openvdb::io::COMPRESS_BLOSC) })
  {
    const Outcome made = InChild([&] { return WriteCloud(Path("cloud.vdb"), compression), 0; });
    const std::string whole = ReadBytes(Path("cloud.vdb"));
    claims.That(made.Code == 0 && PlacesOfCorners(whole).size() == 2, "a small file with two roots");
    claims.That(InChild([&] { return ReadFile(Path("cloud.vdb"), ""); }).Code == 0, "is read");
    for (int i = 0; i < kinds * rounds; ++i, ++seed, files += atOnce)
    {
      const int kind = i % kinds;
      const Outcome outcome = InChild([&] { return ReadMutations(whole, kind, atOnce, seed); });
      allHeld = allHeld && outcome.Code >= 0 && outcome.Code <= atOnce;
      errors += outcome.Code;
      worst[kind] = std::max(worst[kind], outcome.Memory);
    }
  }
  std::cout << files << " mutations of a file of " << ReadBytes(Path("cloud.vdb")).size() << " bytes, " << errors
            << " errors; most memory of each kind, MiB:";
  std::for_each(worst.begin(), worst.end(), [](double memory) { std::cout << " " << std::lround(memory); });
  std::cout << "\n";
  claims.That(allHeld, "every mutation is read or is one error");
  claims.That(*std::max_element(worst.begin(), worst.end()) < 1200.0, "none takes more than a small image may");
}

/// Two voxels, some thousand apart: legal, 20 kB, and an image of `edge`^3.
void WriteTwoVoxels(const std::string& path, int edge)
{
  auto fog = test::NewGrid<openvdb::FloatGrid>("float", "density");
  fog->tree().setValue(openvdb::Coord(0, 0, 0), 1.0f);
  fog->tree().setValue(openvdb::Coord(edge - 1, edge - 1, edge - 1), 2.0f);
  test::WriteGrids(path, { fog });
}

void ASparseFileIsAnErrorThatTellsItsSize(test::Claims& claims)
{
  const std::string path = Path("sparse.vdb");
  claims.That(InChild([&] { return WriteTwoVoxels(path, 900), 0; }).Code == 0, "a sparse file");
  // 900^3 floats are 2.72 GiB.
  const Outcome refused = InChild([&] { return ReadFile(path, "2.72 GiB"); });
  claims.That(refused.Code == 1, "is an error that tells what it needs");
  claims.That(refused.Memory < 100.0, "before it takes it: " + std::to_string(refused.Memory) + " MiB");
  claims.That(InChild([&] { return ReadFile(path, "MaximumMemory"); }).Code == 1, "and what to do");
  claims.That(InChild([&] { return ReadFile(path, "", 4000); }).Code == 0, "which is then read");
  claims.That(InChild([&] { return ReadFile(path, "the limit is 1000 MiB", 1000); }).Code == 1, "within a limit");

  // Small enough by itself, but not for a process that may not take it.
  claims.That(InChild([&] { return WriteTwoVoxels(path, 500), 0; }).Code == 0, "a sparse file");
  claims.That(InChild([&] { return ReadFile(path, ""); }).Code == 0, "500^3 floats, 477 MiB, are read");
  const Outcome tight = InChild([&] {
    long pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const auto most = static_cast<rlim_t>(pages * sysconf(_SC_PAGESIZE) + 400.0 * Mebibyte);
    const struct rlimit limit = { most, most };
    setrlimit(RLIMIT_AS, &limit);
    return ReadFile(path, "available now");
  });
  claims.That(tight.Code == 1, "with 400 MiB of address space they are an error");
  claims.That(tight.Memory < 100.0, "before any is taken");
}

/// An image that says it was one may be as large as memory allows, though its file is small.
void WhatWasAnImageIsReadAgain(test::Claims& claims)
{
  const std::string path = Path("empty.vdb");
  const auto list = [&](std::int64_t cells) {
    return InChild([&, cells] {
      auto fog = test::NewGrid<openvdb::FloatGrid>("float", "density");
      fog->insertMeta("image_extent_min", openvdb::Vec3IMetadata(openvdb::Vec3i(0, 0, 0)));
      fog->insertMeta("image_extent_max", openvdb::Vec3IMetadata(openvdb::Vec3i(700, 700, 700)));
      fog->insertMeta("image_cells", openvdb::Int64Metadata(cells));
      test::WriteGrids(path, { fog });
      vtkNew<vtkVDBReader> reader;
      test::Errors errors(reader);
      reader->SetFileName(path.c_str());
      reader->UpdateInformation();
      return errors.None() ? 0 : errors.WasOneWith("1.28 GiB") ? 1 : 2;
    }).Code;
  };
  claims.That(list(343000000) == 0, "700^3 cells that the file notes are no error");
  claims.That(list(343000001) == 1, "but where the notes contradict each other");
}
}

int TestVDBMemory(int argc, char* argv[])
{
  test::UseFolder("VDBMemory", argc, argv);
  openvdb::initialize();

  test::Claims claims;
  NoMutationTakesMemory(claims);
  ASparseFileIsAnErrorThatTellsItsSize(claims);
  WhatWasAnImageIsReadAgain(claims);
  return claims.Result();
}
