// The same scenes on PoCL and on another OpenCL of this machine: run by on_intel, with Intel's. Where the other is a
// machine without PoCL (a GPU that was lent), or PoCL itself with what GPUs get (TYNDALL_AS_GPU), PoCL's values are
// brought along: TYNDALL_POCL_VALUES is a folder that a run where PoCL alone is chosen fills, and another run reads.

#include "DeviceTest.h"
#include "Difference.h"
#include "LatticeScene.h"
#include "MediumScene.h"
#include "MeshShapes.h"
#include "OrdinatesScene.h"
#include "PhotonScene.h"
#include "ScatteredScene.h"
#include "ViewScene.h"
#include "WholeCounts.h"

#include "LightPropagation/Published/ParallelPropagation.h"

#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
constexpr double Same = 1e-5; ///< of the largest value

Scene Cloud()
{
  Scene scene({ 13, 10, 11 });
  scene.Randomise(2.0, 2.0, 0.9);
  scene.ShineFromEverywhere(1.0);
  scene.ShineAlong({ 0.3, -0.4, -0.8 });
  return scene;
}
}

class DevicesAgree : public testing::Test
{
protected:
  void SetUp() override
  {
    try
    {
      this->Other = Device::Find();
      this->Pocl = this->Folder.empty() ? Device::Find(PoclName) : nullptr;
    }
    catch (const DeviceError& error)
    {
      FAIL() << error.what();
    }
    ASSERT_NE(this->Pocl, this->Other) << "TYNDALL_DEVICE names no other device than PoCL's";
  }

  using Values = std::vector<float>;

  /// @param solve  what is to be the same, by device
  void Compare(const std::function<Values(Device&)>& solve)
  {
    const Values other = solve(*this->Other);
    this->Compare(other, this->Pocl ? solve(*this->Pocl) : this->Brought(other));
  }

  void Compare(const Values& other, const Values& one)
  {
    ASSERT_EQ(one.size(), other.size());
    ASSERT_FALSE(one.empty());
    const double difference = RelativeDifference(other, one);
    this->RecordProperty("difference" + std::to_string(this->Comparisons), std::to_string(difference));
    EXPECT_LT(difference, Same) << "on " << this->Other->Name();
  }

  void CompareMaps(Scene scene)
  {
    scene.settings.netFlux = true;
    const LightField other = scene.Solve(*this->Other);
    const LightField one = this->Pocl ? scene.Solve(*this->Pocl) : LightField();
    this->Compare(other.fluence, this->Pocl ? one.fluence : this->Brought(other.fluence));
    this->Compare(other.netFlux, this->Pocl ? one.netFlux : this->Brought(other.netFlux));
  }

private:
  static constexpr const char* PoclName = "Portable Computing Language";

  /// Of this test's next comparison.
  std::string File()
  {
    return this->Folder + "/" + testing::UnitTest::GetInstance()->current_test_info()->name() + "." +
      std::to_string(this->Comparisons++);
  }

  /// PoCL's values, that were brought along: `found`, and kept, where PoCL itself found them as a CPU.
  Values Brought(const Values& found)
  {
    if (this->Other->Name().find(PoclName) == std::string::npos || !this->Other->IsCpu())
    {
      return this->Read();
    }
    this->Write(found);
    return found;
  }

  void Write(const Values& values)
  {
    std::ofstream file(this->File(), std::ios::binary);
    file.write(
      reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float)));
    ASSERT_TRUE(file.flush()) << "TYNDALL_POCL_VALUES is no folder to write to: " << this->Folder;
  }

  Values Read()
  {
    std::ifstream file(this->File(), std::ios::binary);
    Values values;
    for (float value; file.read(reinterpret_cast<char*>(&value), sizeof value);)
    {
      values.push_back(value);
    }
    return values;
  }

  static std::string FolderSaid()
  {
    const char* said = std::getenv("TYNDALL_POCL_VALUES");
    return said ? said : "";
  }

  std::string Folder = FolderSaid();
  std::shared_ptr<Device> Pocl, Other;
  int Comparisons = 0;
};

TEST_F(DevicesAgree, OnAcceleratedMaps)
{
  this->CompareMaps(Cloud());
}

TEST_F(DevicesAgree, OnMapsOfThreeColoursOrderByOrder)
{
  Scene scene = Cloud();
  scene.settings.acceleration = PropagationAcceleration::None;
  std::vector<float> scattering;
  for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
  {
    scattering.insert(scattering.end(), { scene.sigma_s[i], 0.5f * scene.sigma_s[i], 0.25f * scene.sigma_s[i] });
  }
  scene.sigma_s = scattering;
  scene.emission.assign(scene.sigma_a.size(), 0.1f);
  this->CompareMaps(scene);
}

TEST_F(DevicesAgree, OnMapsRoundAPeriodicAxis)
{
  Scene scene = Cloud();
  scene.settings.periodic = { false, true, false };
  this->CompareMaps(scene);
}

TEST_F(DevicesAgree, OnMapsThatScatterForwards)
{
  Scene scene = Cloud();
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.7);
  this->CompareMaps(scene);
}

TEST_F(DevicesAgree, OnMapsAsPublished)
{
  this->Compare([](Device& device) {
    Scene scene = Cloud();
    scene.Attach();
    scene.settings.maximumOrders = 4;
    return SolveParallel(device, scene.medium, scene.light, scene.settings).fluence;
  });
}

TEST_F(DevicesAgree, OnDiscreteOrdinates)
{
  this->Compare([](Device& device) {
    LitMedium scene({ 9, 8, 7 });
    scene.Randomise(1.0, 1.0, 0.8);
    scene.ShineFromEverywhere(1.0);
    scene.ScatterWith(0.6);
    return scene.SolveOrdinates(device).fluence;
  });
}

TEST_F(DevicesAgree, OnALattice)
{
  this->Compare([](Device& device) {
    Scene scene = Cloud();
    scene.Attach();
    return SolveLatticeBoltzmann(device, Domain(scene.medium.grid), scene.medium, {}, scene.light, {}).fluence;
  });
}

TEST_F(DevicesAgree, OnPhotonsThroughGlass)
{
  this->Compare([](Device& device) {
    PhotonScene scene(16, 1.0, 0.1f, 0.2f);
    scene.SetBall(0.6, 1.3);
    return scene.March(device, RandomPhotons(scene.medium.grid).ThroughAllFaces(20000)).light.fluence;
  });
}

TEST_F(DevicesAgree, OnScatteredPhotons)
{
  this->Compare([](Device& device) {
    PhotonScene scene = UnitCube(8, 3.0, 0.9, 0.5);
    return scene.March(device, RandomPhotons(scene.medium.grid).ThroughAllFaces(20000)).light.fluence;
  });
}

TEST_F(DevicesAgree, OnAPicture)
{
  this->Compare([](Device& device) {
    viewing::Scene scene(viewing::GridOf(12, 9, 10));
    scene.sigma_a = scene.Everywhere(0.05);
    scene.sigma_s = scene.Everywhere(0.1);
    for (std::size_t i = 0; i < scene.grid.VoxelCount(); ++i)
    {
      scene.fluence.push_back(static_cast<float>(i % 17));
    }
    return scene.Seen(device).radiance;
  });
}

TEST_F(DevicesAgree, OnAVoxelizedMesh)
{
  this->Compare([](Device& device) {
    Grid grid{ { 24, 24, 24 } };
    grid.spacing = { 0.1, 0.1, 0.1 };
    grid.origin = { -1.2, -1.2, -1.2 };
    const auto mesh = shapes::Sphere({ 0.0, 0.0, 0.0 }, 1.0);
    const auto counts = CountWhole(device, grid, { { &mesh } }, {}).counts[0];
    return Values(counts.begin(), counts.end());
  });
}
