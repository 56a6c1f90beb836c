// Where PoCL cannot keep what it compiles: each case is a process of its own, for PoCL looks once.
#include "MediumScene.h"

#include "vtkTestUtilities.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <unistd.h>
#include <vector>

namespace
{
namespace fs = std::filesystem;

/// A solver, and what it says.
struct Solve
{
  Solve()
    : errors(this->maps)
  {
    this->maps->SetInputDataObject(test::MakeMedium({ { 3, 3, 3 } }, 0.5, 1.0));
    this->maps->SetSkyColor(1.0, 1.0, 1.0);
  }

  bool GivesLight()
  {
    this->maps->Modified();
    this->maps->Update();
    return this->maps->GetOutput()->GetNumberOfCells() == 27;
  }

  vtkNew<vtkLightPropagationMaps> maps;
  test::Errors errors;
};

/// What PoCL has compiled into a folder and all below.
std::size_t KernelsIn(const fs::path& folder)
{
  const fs::recursive_directory_iterator all(folder);
  return static_cast<std::size_t>(
    std::count_if(begin(all), end(all), [](const auto& entry) { return entry.path().extension() == ".so"; }));
}

/// Grids of other sizes, which ask for work-groups of other sizes, take what the first has compiled.
void OtherSizes(test::Claims& claims, const fs::path& folder)
{
  unsetenv("POCL_WORK_GROUP_SPECIALIZATION");
  setenv("POCL_CACHE_DIR", (folder / "cache").c_str(), 1);
  Solve solve;
  claims.That(solve.GivesLight(), "there is light");
  const std::size_t first = KernelsIn(folder);
  claims.That(first > 0, "kernels were compiled");
  for (const int size : { 5, 11 })
  {
    solve.maps->SetInputDataObject(test::MakeMedium({ { size, size, size } }, 0.5, 1.0));
    solve.maps->Update();
    claims.That(solve.errors.None() && KernelsIn(folder) == first,
      "none was compiled for " + std::to_string(size) + " voxels an edge: " + std::to_string(KernelsIn(folder)) +
        " kernels, of " + std::to_string(first));
  }
}

/// Warned of once, by the first filter; the light is there.
void GoesOnElsewhere(test::Claims& claims, const fs::path& elsewhere, const std::string& trouble)
{
  Solve first, second;
  claims.That(first.GivesLight(), "there is light all the same");
  claims.That(first.errors.WasOneWith(trouble), "one warning says what is wrong: " + trouble);
  claims.That(second.GivesLight() && second.errors.None(), "and only once");
  claims.That(first.GivesLight() && first.errors.None(), "and not again with an update");
  bool kept = false;
  for (const auto& entry : fs::directory_iterator(elsewhere))
  {
    kept = kept || (entry.path().filename().string().rfind("tyndall-pocl-", 0) == 0 && !fs::is_empty(entry.path()));
  }
  claims.That(kept, "what is compiled is kept in a private folder of the temporary directory");
}

void BelowAFile(test::Claims& claims, const fs::path& folder)
{
  std::ofstream(folder / "file") << "text";
  setenv("POCL_CACHE_DIR", (folder / "file" / "below").c_str(), 1);
  GoesOnElsewhere(claims, folder, "below\" (chosen by POCL_CACHE_DIR): Not a directory");
}

void Empty(test::Claims& claims, const fs::path& folder)
{
  setenv("POCL_CACHE_DIR", "", 1);
  GoesOnElsewhere(claims, folder, "it is empty");
}

void HomeBelowAFile(test::Claims& claims, const fs::path& folder)
{
  std::ofstream(folder / "file") << "text";
  unsetenv("POCL_CACHE_DIR");
  unsetenv("XDG_CACHE_HOME");
  setenv("HOME", (folder / "file").c_str(), 1);
  GoesOnElsewhere(claims, folder, ".cache/pocl/kcache\" (chosen by HOME): Not a directory");
}

/// A disk of its own in a folder, which goes with this process.
bool MountDisk(const fs::path& folder, const char* size)
{
  fs::create_directories(folder);
  if (unshare(CLONE_NEWNS) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0)
  {
    return false;
  }
  return mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
    mount("tmpfs", folder.c_str(), "tmpfs", 0, size) == 0;
}

bool FullDisk(test::Claims& claims, const fs::path& folder)
{
  if (!MountDisk(folder / "disk", "size=64k"))
  {
    return false;
  }
  setenv("POCL_CACHE_DIR", (folder / "disk" / "cache").c_str(), 1);
  GoesOnElsewhere(claims, folder, "No space left on device");
  return true;
}

/// There was room at the start.
bool FillsUp(test::Claims& claims, const fs::path& folder)
{
  if (!MountDisk(folder / "disk", "size=24m"))
  {
    return false;
  }
  setenv("POCL_CACHE_DIR", (folder / "disk" / "cache").c_str(), 1);
  Solve solve;
  claims.That(solve.GivesLight() && solve.errors.None(), "a disk with some room will do");
  const fs::path large = folder / "disk" / "large";
  {
    std::ofstream fill(large);
    const std::vector<char> much(1 << 20);
    while (fill.write(much.data(), static_cast<std::streamsize>(much.size())).flush())
    {
    }
  }
  solve.maps->SetScheme(vtkLightPropagationMaps::PUBLISHED); // other programs
  claims.That(!solve.GivesLight(), "there is no light without room for its programs");
  claims.That(solve.errors.WasOneWith("bytes are left there"), "one error says why");
  fs::remove(large);
  claims.That(solve.GivesLight() && solve.errors.None(), "it goes on when there is room again");
  return true;
}

/// No file may be longer than 64 kB, here or elsewhere.
void Nowhere(test::Claims& claims, const fs::path& folder)
{
  setenv("POCL_CACHE_DIR", (folder / "cache").c_str(), 1);
  std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit before = {};
  getrlimit(RLIMIT_FSIZE, &before);
  const struct rlimit small = { 65536, before.rlim_max };
  claims.That(setrlimit(RLIMIT_FSIZE, &small) == 0, "files can be limited");
  Solve solve;
  claims.That(!solve.GivesLight(), "there is no light");
  claims.That(solve.errors.WasOneWith(
                "cache\" (chosen by POCL_CACHE_DIR): File too large; nor in \"" + (folder / "tyndall-pocl-").string()),
    "one error names both folders");
  setrlimit(RLIMIT_FSIZE, &before);
  claims.That(solve.GivesLight() && solve.errors.None(), "it goes on when files can be written again");
}
}

/// @param argv  the case is the last one
int TestCompilerCache(int argc, char* argv[])
{
  char* output = vtkTestUtilities::GetArgOrEnvOrDefault("-T", argc, argv, "TYNDALL_TEST_OUTPUT", ".");
  const std::string name = argv[argc - 1];
  const fs::path folder = fs::absolute(fs::path(output) / ("CompilerCache" + name));
  delete[] output;
  fs::remove_all(folder);
  fs::create_directories(folder);
  setenv("TMPDIR", folder.c_str(), 1);

  test::Claims claims;
  using Case = std::function<bool(test::Claims&, const fs::path&)>;
  const auto always = [](void (*run)(test::Claims&, const fs::path&)) {
    return [run](test::Claims& of, const fs::path& in) {
      run(of, in);
      return true;
    };
  };
  const std::map<std::string, Case> cases = { { "OtherSizes", always(OtherSizes) },
    { "BelowAFile", always(BelowAFile) }, { "Empty", always(Empty) }, { "HomeBelowAFile", always(HomeBelowAFile) },
    { "FullDisk", FullDisk }, { "FillsUp", FillsUp }, { "Nowhere", always(Nowhere) } };
  const auto chosen = cases.find(name);
  if (chosen == cases.end())
  {
    std::cerr << "There is no case " << name << "\n";
    return EXIT_FAILURE;
  }
  if (!chosen->second(claims, folder))
  {
    std::cerr << "This process may not mount a disk.\n";
    return 125;
  }
  return claims.Result();
}
