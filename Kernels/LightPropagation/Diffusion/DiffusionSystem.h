#pragma once

#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Diffusion/AndersonMixing.h"
#include "LightPropagation/Diffusion/CrossingPattern.h"
#include "LightPropagation/Diffusion/DiffusionShared.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"
#include "LightPropagation/Diffusion/SurfacePowers.h"
#include "LightPropagation/Sweep/MomentPlacesShared.h"
#include "Medium/Grid.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace tyndall
{
/// The diffusion system of one channel (numerics.md, section 7): a diffusion-like balance of each voxel's power,
/// corrected by what a sweep found to pass its faces, Eq. (53). Its solution is the fluence of all scattering orders.
///
/// Needs a sweep's path integrals and partial currents for a known source. Iterated with sweeps, the solution as the
/// fluence of the next, it converges in a few of them whatever the thickness and albedo.
///
/// Promises: power is conserved exactly, what leaves one voxel enters the next; in thin voxels, in vacuum and beside
/// borders the solution is the sweep's; in thick ones it is that of diffusion, without the excess of a source that is
/// constant in each voxel (Eqs. (51), (52)). With `linear` false it is the sweep's own solution, with that excess.
///
/// Related: coarse-mesh finite differences (Smith 1983; Cho, Lee and Park 2003), the second-moment method (Lewis and
/// Miller 1976); numerics.md, section 7.11.
class DiffusionSystem
{
public:
  /// The solver's arrays; those of all channels, one after the other, `stride` voxels each.
  struct Arrays
  {
    std::size_t stride, firstT, first; ///< where this channel begins, in sigma_t and in the others
    const Buffer<float>* sigma_t;      ///< 1/length, that light diffuses with: sigma_a and sigma_s (1 - g)
    const Buffer<float>* swept;        ///< 1/length, sigma_t of the sweeps
    const Buffer<float>* sigma_a;      ///< 1/length
    const Buffer<float>* sigma_s;      ///< 1/length
    const Buffer<float>* given;        ///< emitted, and uncollided light that is scattered, W / (length^3 sr)
    MomentPlaces moments;              ///< where angular moments are in `path`, and
    int channel;                       ///< of which channel
    const Buffer<float>*
      givenFlux; ///< of angular moments: net flux over 4 pi, [channel][x, y, z][stride]; null: isotropic
    const Buffer<float>* source;          ///< of a sweep, W / (length^3 sr)
    const Buffer<float>* path;            ///< W length, that it found
    const Buffer<float>* partialCurrents; ///< W, [channel][-x, +x, -y, +y, -z, +z][stride], that it found
    /// W, [channel][-x, +x, -y, +y, -z, +z][stride]: lamps' light that passes a face at once where it is scattered
    /// (LampPassing.h); null: voxels are thin, or there are no lamps
    const Buffer<float>* passed;
    /// W / (length^3 sr), [channel][stride]: what lamps' light is first scattered, less what passes; where that is
    /// there
    const Buffer<float>* ofLamps;
    /// W, [row of DiffusionShared.h][cell of BoxFaces.h]: light by cells of the box's faces, the last row of which
    /// SumBorders() writes; null: no face gives back light, and it is not asked for
    const Buffer<float>* faces = nullptr;
    std::array<double, 6> albedo = {}; ///< of the faces
  };

  /// @param incoming  W / length^2 through the box's faces, but that of lights
  DiffusionSystem(Device& device, const Grid& grid, const std::array<bool, 3>& periodic, const DirectionSet& directions,
    const CrossingPattern& pattern, const Arrays& arrays, const std::array<double, 6>& incoming, bool linear);

  /// Fluence that was solved for last, W / length^2, and with angular moments behind it those of degree 1, [x, y,
  /// z][voxel].
  std::vector<double> State() const { return this->Solution.Read(); }
  /// Sets that on which the next sweep's source is to be built, and from which the next correction is solved for, as
  /// State() has it; else it is 0.
  void Begin(const std::vector<double>& state)
  {
    this->Next.Write(state);
    this->Solution.Write(state);
  }
  /// W / length^2, on which the next sweep's source is to be built: what the last correction led to.
  const ExactValues& NextFluence() const { return this->Next; }
  /// Changes that source at the surfaces of thick voxels such that a sweep finds the outward current of diffusion.
  void ShapeSource();

  // The steps of a correction (DiffusionSolver.h). The system of a rank's block has ghost cells around its own, whose
  // `sigma_s` is below 0: they are excluded from sums.

  void FindModel();                                  ///< of the fluence that the sweep is compared with
  Buffer<float>& TheModel() { return this->Model; }  ///< W / length^2, [voxel]
  void Balance();                                    ///< of each voxel: the right-hand side, from the model
  MultigridSolver& Matrix() { return this->Solver; } ///< and right-hand side
  /// Solves the system of a serial domain on the device, as MultigridSolver::Solve.
  void Solve(double unit, double reduction) { this->Solver.Solve(this->Solution, unit, reduction); }
  static double ReductionAfter(int corrections);     ///< of the residual, in the next solution
  void SetFound(const std::vector<double>& fluence); ///< or takes the solution from the host
  void FindFlux(); ///< that goes with it, the moments of degree 1, where there are angular moments
  static constexpr double RefinedBy = 0.1, RefinedTo = 1e-6; ///< what Refine asks for, of the residual and in units
  AndersonMixing::Sums SumsOfChange() const;                 ///< once the solution is there
  void MixBy(const AndersonMixing::Sums& sums);

  /// Sums over cells of the box's faces: those of which the last correction finds what leaves, W.
  struct BorderSums
  {
    std::array<double, 6> out = {}, seeming = {}, came = {}; ///< by face
    double transportWeight = 0.0, shared = 0.0;              ///< of voxels with several faces, and how many cells
  };
  /// @param counts  whether a cell of a face (by face, and place along the other two axes in order) does
  BorderSums SumBorders(const std::function<bool(int face, int u, int v)>& counts);
  /// W out of the box through each of its faces, by the last correction; 0 where it is periodic.
  /// @param sums  of all ranks
  /// @param entered  W that came in in the sweep
  /// @param ofSweep  W that left through each face in the sweep, by which power at the box's edges is shared among
  /// faces
  static std::array<double, 6> OutflowBy(const BorderSums& sums, double entered, const std::array<double, 6>& ofSweep,
    const std::array<bool, 3>& periodic = {});

  /// Solves on, on the device, for what the last correction found to more digits.
  void Refine(double unit);

  /// W, of what the last correction found.
  double Absorbed() const;

  /// W / length^2, what the last correction found.
  std::vector<double> Found() const;
  /// W through each voxel's faces at the box's, of the last SumBorders.
  SurfacePowers PowersAtSurface() const;

  /// Put into the first moments of a sweep's path those that go with NextFluence(): what the sweep found, and by how
  /// much the net flux of what was solved for differs from it, W length (numerics.md, Eq. (70a)).
  void PutNextFlux(const Buffer<float>& path);

  /// Add the net flux times the voxel's volume to [channel][x, y, z][stride].
  void AddFlux(const Buffer<float>& flux);

private:
  bool Reflects() const;
  std::size_t Values() const { return this->HasMoments() ? 4 * this->Count : this->Count; }
  bool HasMoments() const { return this->The.swept != this->The.sigma_t; }
  const Buffer<float>& Passed() const { return this->The.passed ? *this->The.passed : this->Model; }
  void FindSkins();
  const Buffer<float>& ExtinctionInRows();
  AndersonMixing::Weighting WeightingOfChange() const;
  std::string Options() const;
  cl::Kernel Kernel(const char* name) const;
  cl::Kernel RowsKernel(const char* name) const; ///< that walks along rows
  void Run(cl::Kernel& kernel);                  ///< voxel by voxel
  void RunBorder(cl::Kernel& kernel);            ///< of voxels at the box's faces
  void RunRows(cl::Kernel& kernel) const;
  /// The arguments that the kernels share, then `more`.
  template <class... More>
  cl::Kernel OnArrays(const char* kernel, const More&... more);

  Device& TheDevice;
  DiffusionLayout Layout = {};
  Arrays The;
  std::size_t Count, BorderCells;
  MultigridSolver Solver;
  Buffer<float> FlatSource, Pattern, Model;
  Buffer<cl_int> Skins; ///< by row: whether thick voxels lie beside thinner ones in it
  bool AnySkin = false;
  AndersonMixing Mixing;
  ExactValues Borders;
  ExactValues Next, Solution; ///< of voxels; behind them, where there are moments, those of degree 1, [x, y, z][voxel]
};
}
