#include "TestSupport.h"
#include "VDBScene.h"

#include "vtkNew.h"
#include "vtkVDBReader.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <sys/resource.h>
#include <unistd.h>

using test::IsEmpty;
using test::NewGrid;
using test::Path;
using test::ReadBytes;
using test::SmallFog;
using test::WriteBytes;

namespace
{
/// A small file with every kind of thing in it.
std::string SmallFile(int compression)
{
  auto fog = SmallFog();
  fog->tree().addTile(2, openvdb::Coord(128, 0, 1024), 9.0f, true);
  auto velocity = NewGrid<openvdb::Vec3SGrid>("vec3s", "velocity");
  velocity->setTransform(fog->transformPtr());
  velocity->setSaveFloatAsHalf(true);
  auto inside = NewGrid<openvdb::BoolGrid>("bool", "inside");
  inside->setTransform(fog->transformPtr());
  for (int i = 0; i < 12; ++i)
  {
    velocity->tree().setValue(openvdb::Coord(i, i, 1000), openvdb::Vec3s(float(i)));
    inside->tree().setValue(openvdb::Coord(i, 0, 1000), i % 2 == 0);
  }
  // What does not become smaller by compression is stored as it is.
  auto noise = NewGrid<openvdb::DoubleGrid>("double", "noise");
  noise->setTransform(fog->transformPtr());
  for (int i = 0; i < 4; ++i)
  {
    noise->tree().setValue(openvdb::Coord(0, i, 1000), std::sqrt(i + 2.0));
  }
  openvdb::io::File file(Path("small.vdb"));
  file.setCompression(static_cast<std::uint32_t>(compression) | openvdb::io::COMPRESS_ACTIVE_MASK);
  file.write({ fog, velocity, inside, noise });
  file.close();
  return ReadBytes(Path("small.vdb"));
}

/// Damaged files: one error and no data, or data (what is damaged then is a value); and always a living application.
void DamagedFilesAreErrors(test::Claims& claims)
{
  vtkNew<vtkVDBReader> reader;
  reader->SetMaximumMemory(256);
  test::Errors errors(reader);
  const std::string path = Path("damaged.vdb");
  std::size_t truncations = 0, flips = 0, errorsOfFlips = 0, lengths = 0;
  const auto readIt = [&](const char* part = "damaged.vdb") {
    reader->SetFileName(path.c_str());
    reader->Modified();
    reader->Update();
    const bool failed = !errors.None();
    return failed && errors.WasOneWith(part) && IsEmpty(reader->GetOutput()) ? 1 : failed ? -1 : 0;
  };
  const auto read = [&](const std::string& bytes, const char* part = "damaged.vdb") {
    WriteBytes(path, bytes);
    return readIt(part);
  };
  std::mt19937 random(20261121);
  for (int compression :
    { int(openvdb::io::COMPRESS_NONE), int(openvdb::io::COMPRESS_ZIP), int(openvdb::io::COMPRESS_BLOSC) })
  {
    const std::string whole = SmallFile(compression);
    claims.That(read(whole) == 0, "the whole file is read");
    bool allFound = true;
    const std::size_t step = compression == openvdb::io::COMPRESS_BLOSC ? 1 : 17;
    for (std::size_t cut = 1; cut <= whole.size(); cut += step, ++truncations)
    {
      allFound = truncate(path.c_str(), static_cast<off_t>(whole.size() - cut)) == 0 && readIt() == 1 && allFound;
    }
    claims.That(allFound, "every truncation is one error and no data");
    bool oneError = true;
    for (int seed = 0; seed < 1000; ++seed, ++flips)
    {
      std::string bytes = whole;
      for (int count = 1 + static_cast<int>(random() % 4); count > 0; --count)
      {
        bytes[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
      }
      if (seed % 3 == 0)
      {
        bytes[random() % bytes.size()] = static_cast<char>(random());
      }
      const int result = read(bytes);
      oneError = oneError && result >= 0;
      errorsOfFlips += result == 1;
    }
    claims.That(oneError, "flipped bits are one error or other values");

    // What OpenVDB believes: a block of values stored as it is says its length, negative. It must not come that far: it
    // would write beyond the node.
    bool longer = true;
    for (std::size_t at = 0; at + sizeof(std::int64_t) <= whole.size(); ++at)
    {
      std::int64_t length;
      std::memcpy(&length, &whole[at], sizeof(length));
      if (length < 0 && length >= -512 * 8) // at most a leaf of doubles
      {
        std::string bytes = whole;
        length -= 30000;
        std::memcpy(&bytes[at], &length, sizeof(length));
        longer = read(bytes, "wrong length") == 1 && longer;
        ++lengths;
      }
    }
    claims.That(longer, "a block that claims to be longer than its node is an error");
  }
  claims.That(lengths > 0, "there are blocks that are stored as they are");
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  std::cout << truncations << " truncations, " << flips << " files with flipped bits (" << errorsOfFlips
            << " of them errors), " << lengths << " wrong lengths, peak memory " << usage.ru_maxrss / 1024 << " MiB\n";
  claims.That(usage.ru_maxrss < 1500L * 1024, "no damaged file makes the reader allocate wildly");
}
}

int TestVDBDamage(int argc, char* argv[])
{
  test::UseFolder("VDBDamage", argc, argv);
  openvdb::initialize();

  test::Claims claims;
  DamagedFilesAreErrors(claims);
  return claims.Result();
}
