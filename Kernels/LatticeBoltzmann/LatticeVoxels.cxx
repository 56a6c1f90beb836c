#include "LatticeBoltzmann/LatticeVoxels.h"

#include "Device/Errors.h"
#include "LatticeBoltzmann/LatticeShared.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tyndall
{
namespace
{
/// A closed line of links, which returns to its first voxel around periodic axes, counts as endless if its voxels
/// remove, on average, less than this fraction of the light per step. The second value applies if all axes are
/// periodic: all lines then close, and in thin media light must travel many times around a line before it is removed.
constexpr double LeastEnding = 1e-3, LeastEndingInClosedBox = 1e-12;

/// Probability that diffuse light that starts between two points reaches the farther point before the nearer one, and
/// is not absorbed (p of numerics.md, Eq. (L13)).
/// @param way  diffusive resistance to the nearer point, relative to that between both
/// @param decays  number of e-folds by which diffuse light decays between both points
double PartThatCrosses(double way, double decays)
{
  if (decays < 1e-3)
  {
    return way;
  }
  return std::exp((way - 1.0) * decays) * std::expm1(-2.0 * way * decays) / std::expm1(-2.0 * decays);
}

/// Number of e-folds by which diffuse light decays across a voxel: its edge in diffusion lengths.
double DecaysAcross(const Medium& medium, std::size_t voxel, int channel)
{
  const double absorbs = medium.sigma_a.At(voxel, channel);
  return medium.grid.spacing[0] * std::sqrt(3.0 * absorbs * medium.TransportSigmaT(voxel, channel));
}

/// Lines of links, along a pair of directions in the whole grid, that are closed: they wrap around periodic axes and
/// return to their first voxel.
class ClosedLines
{
public:
  ClosedLines(const std::array<int, 3>& size, const std::array<bool, 3>& periodic, int pair)
    : Size(size)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const int way = LatticeWays[2 * pair][axis];
      this->Ways[axis] = way;
      this->Close = this->Close && (way == 0 || periodic[axis]);
      this->Common = way != 0 ? std::gcd(this->Common, size[axis]) : this->Common;
      this->Across *= way == 0 ? static_cast<std::size_t>(size[axis]) : 1;
    }
    this->IsDiagonal = std::count(this->Ways.begin(), this->Ways.end(), 0) == 1;
  }

  /// Number of closed lines; 0 if lines of the pair do not close.
  std::size_t Count() const
  {
    return this->Close ? this->Across * (this->IsDiagonal ? static_cast<std::size_t>(this->Common) : 1) : 0;
  }

  /// Index of the closed line through a voxel. The voxel's indices may lie outside the grid along periodic axes.
  std::size_t Through(const std::array<int, 3>& voxel) const
  {
    std::size_t line = 0;
    // sum or difference of the voxel's two indices that change along a diagonal line; on one line it is constant modulo
    // Common, the greatest common divisor of the grid's sizes along these two axes
    int along = 0;
    int sign = 1;
    for (int axis = 0; axis < 3; ++axis)
    {
      const int at = (voxel[axis] % this->Size[axis] + this->Size[axis]) % this->Size[axis];
      if (this->Ways[axis] == 0)
      {
        line = line * static_cast<std::size_t>(this->Size[axis]) + static_cast<std::size_t>(at);
      }
      else
      {
        along += sign * this->Ways[axis] * at;
        sign = -1;
      }
    }
    const int number = (along % this->Common + this->Common) % this->Common;
    return this->IsDiagonal ? line * static_cast<std::size_t>(this->Common) + static_cast<std::size_t>(number) : line;
  }

private:
  std::array<int, 3> Size, Ways = {};
  std::size_t Across = 1;
  int Common = 0;
  bool Close = true, IsDiagonal = false;
};
}

double LatticeWeight(int directions, int i)
{
  return directions == 6 ? 1.0 / 6.0 : i < 6 ? 1.0 / 12.0 : 1.0 / 24.0;
}

double LatticeSquares(int directions)
{
  return directions == 6 ? 1.0 / 3.0 : 0.5;
}

LatticeVoxels::LatticeVoxels(
  const LatticeProblem& problem, const LatticeSettings& settings, const Uncollided& direct, int channel)
  : Problem(problem)
  , Channel(channel)
  , Directions(settings.directions)
{
  const Domain& domain = problem.TheDomain();
  domain.Collective([&] { this->Load(settings); });
  this->ReduceGlobals();
  this->LoadBoundary();
  domain.Collective([&] { this->LoadSources(direct); });
  const bool anyPeriodic = settings.periodic[0] || settings.periodic[1] || settings.periodic[2];
  if (anyPeriodic && settings.scheme == LatticeScheme::Conservative)
  {
    this->FindEndless(settings.periodic);
    domain.Collective([&] { this->CheckLightEnds(); });
  }
}

void LatticeVoxels::Load(const LatticeSettings& settings)
{
  const Medium& medium = this->Problem.TheMedium();
  const Field& ior = this->Problem.Index();
  const double edge = medium.grid.spacing[0];
  const bool published = settings.scheme == LatticeScheme::Published;
  // Optical thickness of a voxel up to which links transmit all light. At this thickness a collision makes all of the
  // density isotropic (Eqs. (L2), (L3)).
  const double most = 2.0 / (3.0 * LatticeSquares(settings.directions));
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    const double s = edge * medium.TransportSigmaT(i, this->Channel);
    const double absorbs = edge * medium.sigma_a.At(i, this->Channel);
    this->thickest = std::max(this->thickest, s);
    const double even = s > 0.0 ? std::min(1.0, 1.0 / (0.5 + 0.5 * most / s)) : 0.0;
    this->turning.push_back(static_cast<float>(published ? s - absorbs : even));
    this->lost.push_back(static_cast<float>(published ? absorbs : -std::expm1(-absorbs)));
    this->kept.push_back(published ? static_cast<float>(1.0 - s) : 1.0f - this->lost.back());
    this->passes.push_back(static_cast<float>(!published && s > most ? most / s : 1.0));
    const double lost = this->lost.back();
    this->begins.push_back(published || absorbs < 1e-6 ? 1.0 : 2.0 * lost / ((2.0 - lost) * absorbs));
    this->squared.push_back(ior.values && !published ? ior.At(i, 0) * ior.At(i, 0) : 1.0f);
    this->passesAll = this->passesAll && this->passes.back() == 1.0f;
  }
}

/// Combines passesAll, bends and thickest over all ranks, so that all ranks use the same kernel options. Collective.
void LatticeVoxels::ReduceGlobals()
{
  const bool has = !this->squared.empty();
  const auto ends = std::minmax_element(this->squared.begin(), this->squared.end());
  const std::vector<double> all =
    this->Problem.TheDomain().Comm().Largest({ this->passesAll ? 0.0 : 1.0, has ? 1.0 * *ends.second : 0.0,
      has ? -1.0 * *ends.first : -std::numeric_limits<double>::infinity(), this->thickest });
  this->passesAll = all[0] == 0.0;
  this->bends = all[1] != -all[2];
  this->thickest = all[3];
}

/// Marks closed lines that remove almost no light as endless. Collective.
void LatticeVoxels::FindEndless(const std::array<bool, 3>& periodic)
{
  const Domain& domain = this->Problem.TheDomain();
  const LatticeBox& box = this->Problem.Box();
  const Grid& whole = domain.Whole();
  const double ofVoxel = periodic[0] && periodic[1] && periodic[2] ? LeastEndingInClosedBox : LeastEnding;
  const auto inWhole = [&](std::size_t i) {
    std::array<int, 3> at = box.known.VoxelAt(i);
    for (int axis = 0; axis < 3; ++axis)
    {
      at[axis] += domain.Own().first[axis] - box.own.first[axis];
    }
    return at;
  };
  std::vector<float> bits(box.known.VoxelCount(), 0.0f);
  for (int pair = 0; pair < this->Directions / 2; ++pair)
  {
    const ClosedLines lines(whole.size, periodic, pair);
    if (lines.Count() == 0)
    {
      continue;
    }
    const double least = ofVoxel * static_cast<double>(whole.VoxelCount()) / static_cast<double>(lines.Count());
    std::vector<double> inALap(lines.Count(), 0.0);
    for (std::size_t i = 0; i < box.Count(); ++i)
    {
      const std::size_t voxel = box.Known(i);
      inALap[lines.Through(inWhole(voxel))] += 1.0 - (1.0 - this->lost[voxel]) * (1.0 - this->turning[voxel]);
    }
    inALap = domain.Sum(inALap);
    for (std::size_t i = 0; i < bits.size(); ++i)
    {
      bits[i] += inALap[lines.Through(inWhole(i))] < least ? static_cast<float>(1 << pair) : 0.0f;
    }
  }
  if (std::any_of(bits.begin(), bits.end(), [](float bit) { return bit > 0.0f; }))
  {
    this->endless = std::move(bits);
  }
}

void LatticeVoxels::CheckLightEnds() const
{
  const auto all = static_cast<float>((1 << this->Directions / 2) - 1);
  for (std::size_t i = 0; i < this->endless.size(); ++i)
  {
    if (this->endless[i] == all && this->source[i] > 0.0f)
    {
      throw InvalidInput("What begins in voxel " + VoxelName(this->Problem.Box().known, i) +
        " meets nothing round the three periodic axes: light would grow without end. Leave an axis open, or give the "
        "medium some sigma_a there.");
    }
  }
}

double LatticeVoxels::OpenWeight(std::size_t voxel) const
{
  double open = 1.0;
  const int bits = this->endless.empty() ? 0 : static_cast<int>(this->endless[voxel]);
  for (int pair = 0; pair < this->Directions / 2; ++pair)
  {
    open -= bits >> pair & 1 ? 2.0 * LatticeWeight(this->Directions, 2 * pair) : 0.0;
  }
  // At least the weight of one direction, so that the result is above 0 even if all lines are endless.
  return std::max(open, LatticeWeight(this->Directions, this->Directions - 1));
}

/// Sets `incoming` and `albedo` of the box's faces.
void LatticeVoxels::LoadBoundary()
{
  const Illumination& shining = this->Problem.TheIllumination();
  const auto c = static_cast<std::size_t>(this->Channel);
  const double even = this->bends || this->squared.empty() ? 1.0 : this->squared.front();
  for (std::size_t face = 0; face < 6; ++face)
  {
    this->incoming[face] = 4.0 * Pi * (shining.sky[c] + shining.faces[face][c]) * even;
    this->albedo[face] = shining.faceAlbedo[face][c];
  }
}

void LatticeVoxels::LoadSources(const Uncollided& direct)
{
  const Medium& medium = this->Problem.TheMedium();
  const int channel = this->Channel;
  const double edge = medium.grid.spacing[0];
  std::vector<double> begin(medium.grid.VoxelCount());
  for (std::size_t i = 0; i < begin.size(); ++i)
  {
    begin[i] = edge * medium.sigma_s.At(i, channel) * direct.image.fluence.At(i, channel);
  }
  this->crossing.clear();
  if (!direct.firstMoments.empty())
  {
    this->CrossFaces(direct, begin);
  }
  this->source.resize(begin.size());
  for (std::size_t i = 0; i < begin.size(); ++i)
  {
    const double emitted = edge * 4.0 * Pi * medium.emission.At(i, channel);
    this->source[i] = static_cast<float>(this->begins[i] * (begin[i] + emitted));
  }
}

/// Moves a fraction of the first-collision source of each voxel across its faces (Eq. (L13)). The fraction is linear in
/// the distance of the mean collision position from the centre, so that lights superpose. It is 0 in voxels with g > 0,
/// because forward-scattered light does not return to its entry face at once.
/// @param begin  first-collision source of each voxel, W / length^2; changed
void LatticeVoxels::CrossFaces(const Uncollided& direct, std::vector<double>& begin)
{
  const Medium& medium = this->Problem.TheMedium();
  const int channel = this->Channel;
  const std::vector<double> scattered = begin;
  this->crossing.assign(6 * begin.size(), 0.0f);
  for (std::size_t i = 0; i < begin.size(); ++i)
  {
    if (!(begin[i] > 0.0) || medium.phase.MeanCosine(i, channel) > 0.0)
    {
      continue;
    }
    std::array<double, 6> parts = {};
    // e-folds of diffuse light from the voxel's centre to a face
    const double decays = 0.5 * DecaysAcross(medium, i, channel);
    const double normal = NearerOfNormalBeam(medium, i, channel);
    for (std::size_t face = 0; face < 6; ++face)
    {
      const double nearer = direct.Nearer(i, channel, face);
      const double part = nearer > 0.0 ? this->PartWithin(i, face) : 0.0;
      parts[face] = part > 0.0 ? nearer / normal * PartThatCrosses(2.0 * normal * part, decays / part) : 0.0;
    }
    // Divisor of the fractions that cross the faces: in voxels lit through several faces it limits their sum to 1.
    const double all = std::max(std::accumulate(parts.begin(), parts.end(), 0.0), 1.0);
    for (std::size_t face = 0; face < 6; ++face)
    {
      const double crosses = parts[face] / all * scattered[i];
      const std::size_t beyond = this->Problem.Box().Beyond(i, face);
      this->crossing[6 * i + face] = static_cast<float>(crosses);
      begin[i] = std::max(begin[i] - crosses, 0.0);
      if (beyond != Outside)
      {
        begin[beyond] += crosses;
      }
    }
  }
}

/// Diffusive resistance from a voxel's centre to its face, divided by the resistance to the neighbour's centre or, at a
/// face of the box, to the outside of the box.
double LatticeVoxels::PartWithin(std::size_t voxel, std::size_t face) const
{
  const std::size_t beyond = this->Problem.Box().Beyond(voxel, face);
  const double within = this->ResistanceWithin(voxel);
  const double all = beyond == Outside ? this->ResistanceOfFace(voxel, face) : this->ResistanceBetween(voxel, beyond);
  return within > 0.0 && beyond != voxel ? within / all : 0.0;
}

double LatticeVoxels::ResistanceWithin(std::size_t voxel, double least) const
{
  const double squares = LatticeSquares(this->Directions);
  const double straight = (1.0 - this->lost[voxel]) * (1.0 - this->turning[voxel]);
  const double removed = std::max(1.0 - straight, least);
  return removed > 0.0 ? 1.0 / (2.0 * squares * (1.0 / removed - 0.5) * this->passes[voxel] * this->squared[voxel])
                       : 0.0;
}

double LatticeVoxels::ResistanceBetween(std::size_t a, std::size_t b, double least) const
{
  const double reflects = std::abs(1.0 / this->squared[a] - 1.0 / this->squared[b]);
  return this->ResistanceWithin(a, least) + this->ResistanceWithin(b, least) +
    reflects / LatticeSquares(this->Directions);
}

double LatticeVoxels::ResistanceOfFace(std::size_t voxel, std::size_t face, double least) const
{
  // Inverse resistance of a black face, by Marshak's condition.
  const double black = LatticeSquares(this->Directions) * this->squared[voxel];
  const double reflects = (1.0 + this->albedo[face]) / (1.0 - this->albedo[face]);
  return this->ResistanceWithin(voxel, least) + reflects / black;
}

bool LatticeVoxels::Reflects() const
{
  return std::any_of(this->albedo.begin(), this->albedo.end(), [](double albedo) { return albedo > 0.0; });
}

double LatticeVoxels::Given() const
{
  return std::accumulate(this->incoming.begin(), this->incoming.end(), 0.0) +
    std::accumulate(this->source.begin(), this->source.end(), 0.0);
}
}
