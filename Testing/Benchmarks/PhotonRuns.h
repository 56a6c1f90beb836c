#pragma once

#include "MachineLimits.h"
#include "Report.h"

#include "Device/Device.h"
#include "Photons/Emission/PhotonEmitter.h"
#include "Photons/Marching/PhotonMarcher.h"
#include "Refraction/Index/RefractiveMedium.h"
#include "Refraction/Octree/RefractionOctree.h"

#include <functional>
#include <string>
#include <vector>

/// Scenes, clocks and lines that the photons' tables share.
namespace bench
{
constexpr std::size_t PaperPhotons = 122000;

/// Medians of several runs, seconds.
struct PhotonTimes
{
  double seconds = 0.0;     ///< of the part that the run itself tells
  double coreSeconds = 0.0; ///< of all of it, a compute unit
};

/// @param run  tells the seconds of the part of it that counts. It runs once before: compiles, and takes the memory
PhotonTimes Repeat(tyndall::Device& device, int runs, const std::function<double()>& run);

double Timed(const std::function<void()>& work);

/// A solid of glass in fog that fills a box, under a lamp: Pfeuti's Figures 4.7 and 4.11. Stage by stage.
struct PaperScene
{
  std::string name;
  tyndall::RefractiveMediumSettings settings;
  tyndall::Solid solid;
  tyndall::Illumination light;
  tyndall::RefractiveMedium voxels;
  tyndall::Octree octree;
  std::vector<tyndall::Photon> photons;

  void Voxelize(tyndall::Device& device);
  void Group(double tolerance = 0.01);
  void Emit(std::size_t count, tyndall::Sampler sampler = tyndall::Sampler::Hammersley, std::uint64_t seed = 0);

  tyndall::Medium Medium() const;
  tyndall::Field Index() const { return { this->voxels.ior.data(), 1 }; }
  tyndall::PhotonMarcher Marcher(
    tyndall::Device& device, const tyndall::MarchSettings& settings = {}, bool octree = true) const;
};

PaperScene BallInFog(int edge);
PaperScene MeshInFog(const std::string& name, tyndall::TriangleMesh mesh, int edge);

/// A figure's name, as design.md section 4 has it.
JsonLine PhotonLine(const char* what, const std::string& method, const tyndall::Grid& grid = {});

/// Bytes that photons move where they deposit voxels: each deposit reads and writes the voxel's sums of light and of
/// directions, 8 bytes a number, and reads its extinction, 4 bytes.
double BytesOfDeposits(const tyndall::PhotonLight& light);

/// Time, steps and deposits of a march. @param bandwidth  of the machine, bytes / s
void PrintMarch(const char* what, const std::string& method, const PaperScene& scene, tyndall::Device& device,
  const PhotonTimes& times, const tyndall::PhotonLight& light, double bandwidth);

/// Root of the sum of squared differences, over that of the reference.
double RelativeL2(const std::vector<float>& values, const std::vector<float>& reference);

/// The order of an error that fell from `before` to `now` while steps became `ratio` times shorter.
double ObservedOrder(double before, double now, double ratio);
}
