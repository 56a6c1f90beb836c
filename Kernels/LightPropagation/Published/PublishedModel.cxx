#include "LightPropagation/Published/PublishedModel.h"

#include "Device/Errors.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tyndall
{
namespace
{
constexpr double FourPi = 4.0 * Pi;

int NearestOf(const std::vector<std::array<double, 3>>& directions, const std::array<double, 3>& omega)
{
  int best = 0;
  double largest = -2.0;
  for (std::size_t d = 0; d < directions.size(); ++d)
  {
    const double cosine = glm::dot(Vector(directions[d]), Vector(omega));
    if (cosine > largest + 1e-12) // the first of equally near directions is taken
    {
      largest = cosine;
      best = static_cast<int>(d);
    }
  }
  return best;
}

/// Indices of the directions nearest to 48 slightly displaced copies of a unit vector. The displacements are images of
/// each other under the symmetries of the cube. All 48 indices are equal unless omega lies on a border between cells.
std::vector<int> NearestAround(const DirectionSet& set, const std::array<double, 3>& omega)
{
  std::array<double, 3> push = { 1e-9, 2e-9, 3e-9 };
  std::vector<int> nearest;
  do
  {
    for (int signs = 0; signs < 8; ++signs)
    {
      std::array<double, 3> pushed = omega;
      for (int a = 0; a < 3; ++a)
      {
        pushed[a] += (signs >> a & 1) != 0 ? -push[a] : push[a];
      }
      nearest.push_back(Nearest(set, pushed));
    }
  } while (std::next_permutation(push.begin(), push.end()));
  return nearest;
}

std::vector<std::array<Rgb, 3>> BoundaryOf(
  const DirectionSet& set, const Illumination& illumination, const std::array<bool, 3>& periodic)
{
  std::vector<Rgb> distant = BoundaryRadiance(set, illumination.environment, illumination.sky);
  for (const Light& light : illumination.lights)
  {
    if (light.type == LightType::Directional)
    {
      const std::vector<int> nearest = NearestAround(set, DirectionOf(light));
      for (const int i : nearest)
      {
        for (int c = 0; c < 3; ++c)
        {
          distant[i][c] += light.power[c] / (set.directions[i].weight * static_cast<double>(nearest.size()));
        }
      }
    }
  }
  std::vector<std::array<Rgb, 3>> boundary(set.directions.size());
  for (std::size_t i = 0; i < boundary.size(); ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const int face = EntryFace(axis, set.directions[i].omega[axis] >= 0.0);
      for (int c = 0; c < 3 && !periodic[axis]; ++c)
      {
        boundary[i][axis][c] = distant[i][c] + illumination.faces[face][c];
      }
    }
  }
  return boundary;
}

/// A small patch of the unit sphere: its centre, its solid angle (sr), and the index of the stored direction in whose
/// cell it lies.
struct Patch
{
  glm::dvec3 omega;
  double weight;
  int stored;
};

std::vector<Patch> Patches(const std::vector<std::array<double, 3>>& stored)
{
  std::vector<Patch> patches;
  for (const Direction& direction : EquiangularDirections(30 * 30).directions)
  {
    patches.push_back({ Vector(direction.omega), direction.weight, NearestOf(stored, direction.omega) });
  }
  return patches;
}

/// Table of the mean of a phase function over a patch of the sphere, as a function of the angle between the light's
/// direction and the patch. The mean is taken over a ring around the light's direction, as wide as a round patch of the
/// same area. It is exact on the ring, so a forward peak narrower than a patch keeps its power.
class PatchMeans
{
public:
  PatchMeans(const PhaseFunction& function, double solidAngle)
  {
    const double radius = std::sqrt(solidAngle / Pi);
    for (int row = 0; row <= Rows + 1; ++row)
    {
      const double angle = 2.0 * std::asin(std::min(1.0, static_cast<double>(row) / Rows));
      const double inner = std::cos(std::max(angle - radius, 0.0)), outer = std::cos(std::min(angle + radius, Pi));
      this->Means.push_back((function.Below(inner) - function.Below(outer)) / (2.0 * Pi * (inner - outer)));
    }
  }

  /// Mean of the phase function, 1/sr, for this cosine of the angle between the light's direction and the patch.
  double At(double cosine) const
  {
    // Rows of the table have equal steps of sin(angle / 2)
    const double place = Rows * std::sqrt(std::max(0.5 * (1.0 - cosine), 0.0));
    const int row = std::min(static_cast<int>(place), static_cast<int>(Rows));
    return this->Means[row] + (place - row) * (this->Means[row + 1] - this->Means[row]);
  }

private:
  static constexpr int Rows = 4096;
  std::vector<double> Means;
};

/// F^{i,d} / |Omega^d| of Eq. (5), 1/sr, for all stored directions d (rows) and all propagation directions i (columns):
/// the integral of the phase function over the cells of both directions (numerics.md, Eq. (12)).
std::vector<std::vector<double>> ScatteringFactors(
  const PhaseFunction& function, const DirectionSet& set, const std::vector<std::array<double, 3>>& stored)
{
  const std::vector<Patch> patches = Patches(stored);
  const PatchMeans means(function, FourPi / static_cast<double>(patches.size()));
  std::vector<std::vector<double>> factors(stored.size(), std::vector<double>(set.directions.size(), 0.0));
  std::vector<double> solidAngle(stored.size(), 0.0);
  std::vector<double> cellSize(set.directions.size(), 0.0);
  std::vector<double> scattered(stored.size());
  const auto addPatch = [&](const Patch& from, std::size_t i) {
    std::fill(scattered.begin(), scattered.end(), 0.0);
    double all = 0.0;
    for (const Patch& to : patches)
    {
      const double p = to.weight * means.At(glm::dot(from.omega, to.omega));
      scattered[to.stored] += p;
      all += p;
    }
    for (std::size_t d = 0; d < stored.size(); ++d)
    {
      // `all` differs from 1, because PatchMeans averages over rings instead of patches; dividing by it conserves power
      factors[d][i] += from.weight * scattered[d] / all;
    }
    cellSize[i] += from.weight;
  };
  for (const Patch& from : patches)
  {
    solidAngle[from.stored] += from.weight;
    addPatch(from, Nearest(set, { from.omega.x, from.omega.y, from.omega.z }));
  }
  for (std::size_t i = 0; i < set.directions.size(); ++i)
  {
    if (cellSize[i] == 0.0) // no patch lies in this cell: there are more directions than patches
    {
      addPatch({ Vector(set.directions[i].omega), set.directions[i].weight, 0 }, i);
    }
    for (std::size_t d = 0; d < stored.size(); ++d)
    {
      factors[d][i] *= solidAngle[d] > 0.0 ? set.directions[i].weight / (cellSize[i] * solidAngle[d]) : 0.0;
    }
  }
  return factors;
}

/// Chooses `count` directions that are evenly distributed over the sphere: cell centres of the cube faces if count is 6
/// n^2, else Fibonacci points.
std::vector<std::array<double, 3>> EvenDirections(int count)
{
  std::vector<std::array<double, 3>> directions;
  const int edge = static_cast<int>(std::lround(std::sqrt(count / 6.0)));
  if (edge >= 1 && edge <= 64 && 6 * edge * edge == count)
  {
    for (const Direction& direction : EquiangularDirections(edge * edge).directions)
    {
      directions.push_back(direction.omega);
    }
    return directions;
  }
  const double goldenAngle = Pi * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i)
  {
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double sine = std::sqrt(1.0 - z * z);
    directions.push_back({ sine * std::cos(goldenAngle * i), sine * std::sin(goldenAngle * i), z });
  }
  return directions;
}
}

std::vector<std::string> LeftOutAsPublished(const Illumination& illumination)
{
  int near = 0;
  for (const Light& light : illumination.lights)
  {
    near += light.type != LightType::Directional ? 1 : 0;
  }
  if (near == 0)
  {
    return {};
  }
  return {
    std::to_string(near) +
    " point, spot or rectangle light(s) do not shine: the published scheme has light from outside only; take Scheme 1"
  };
}

namespace
{
using Moment = std::function<std::vector<float>(int)>;

std::string WhyNotPublished(const PhaseOfMedium& phase)
{
  return phase.Varies() ? "the mean cosine g differs between voxels, and the published scheme has one phase function"
    : phase.HasColour() ? "the phase function (g) differs between channels, and the published scheme has one for all"
                        : "";
}

int ChannelsOf(const Medium& medium, const Illumination& illumination)
{
  const bool coloured =
    medium.Channels() == 3 || illumination.uncollided.fluence.HasColour() || !ColourOf(illumination).IsGrey();
  return coloured ? 3 : 1;
}

std::vector<float> ScatteredRadiance(const PublishedModel& model, const Moment& moment)
{
  const std::size_t stored = model.StoredDirections().size();
  const std::size_t channels = static_cast<std::size_t>(model.Channels());
  std::vector<float> radiance;
  for (std::size_t d = 0; d < stored; ++d)
  {
    const PublishedModel::Part part = model.ScatteredRadiance(static_cast<int>(d));
    const std::vector<float> values = moment(part.moment);
    radiance.resize(values.size() * stored);
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      radiance[(i / channels * stored + d) * channels + i % channels] = static_cast<float>(part.factor) * values[i];
    }
  }
  return radiance;
}

std::vector<float> NetFlux(const PublishedModel& model, const Moment& moment)
{
  std::vector<float> netFlux;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::vector<float> flux = moment(model.NetFlux(axis));
    netFlux.resize(3 * flux.size());
    for (std::size_t i = 0; i < flux.size(); ++i)
    {
      netFlux[3 * i + axis] = flux[i];
    }
  }
  return netFlux;
}

std::vector<std::string> LeftOut(const Medium& medium, const MediumTraits& traits, const Illumination& illumination,
  const PropagationSettings& settings, std::size_t orders)
{
  std::vector<std::string> words = LeftOutAsPublished(illumination);
  const auto say = [&](bool condition, const char* text) {
    if (condition)
    {
      words.emplace_back(text);
    }
  };
  const bool leaveOut = settings.leaveOut;
  say(illumination.uncollided.IsThere(), left_out::OwnUncollided);
  say(leaveOut && medium.phase.IsIsotropic() && traits.scatters, left_out::Isotropic);
  say(leaveOut && !traits.scatters, left_out::NoScattering);
  say(leaveOut && !traits.emits, left_out::NoEmission);
  say(leaveOut, left_out::BlackFaces);
  say(leaveOut && traits.scatters && orders == 1, left_out::OneOrder);
  say(!settings.netFlux, left_out::NetFlux);
  return words;
}
}

std::string WhyNotPublished(const Medium& medium, const Illumination& illumination)
{
  return Reflects(illumination) ? "faces reflect (FaceAlbedo), and no published scheme has such faces"
                                : WhyNotPublished(medium.phase);
}

void CheckPublished(const Medium& medium, const Illumination& illumination)
{
  CheckPublishedFaces(illumination);
  const std::string why = WhyNotPublished(medium.phase);
  Require(why.empty(),
    "This medium cannot be solved as published: " + why +
      ". Take the conservative scheme (Scheme 1), or give the medium one.");
}

void CheckPublishedFaces(const Illumination& illumination)
{
  Require(!Reflects(illumination),
    "FaceAlbedo is not 0, and the published scheme has no faces that reflect. Take the conservative scheme (Scheme 1), "
    "or set FaceAlbedo to 0.");
}

void AddGiven(const PublishedModel& model, const UncollidedImage& image, std::size_t voxels,
  const std::function<void(std::size_t, std::size_t, int, double)>& add)
{
  const Field& mean = image.meanDirection;
  for (std::size_t voxel = 0; voxel < voxels; ++voxel)
  {
    const std::vector<double> moments = model.MomentsAlong({ mean.At(voxel, 0), mean.At(voxel, 1), mean.At(voxel, 2) });
    for (std::size_t k = 0; k < moments.size(); ++k)
    {
      for (int c = 0; c < model.Channels(); ++c)
      {
        add(k, voxel, c, moments[k] * image.fluence.At(voxel, c));
      }
    }
  }
}

void WritePublishedLight(const PublishedModel& model, const Medium& medium, const MediumTraits& traits,
  const Illumination& illumination, const PropagationSettings& settings, const Moment& moment, LightField& field)
{
  field.channels = model.Channels();
  field.fluence = moment(0);
  field.storedDirections = model.StoredDirections();
  field.scatteredRadiance = ScatteredRadiance(model, moment);
  field.netFlux = settings.netFlux ? NetFlux(model, moment) : std::vector<float>();
  field.leftOut = LeftOut(medium, traits, illumination, settings, field.convergence.size());
  field.halfRangeFlux.fill(HalfRangeFlux(model.Directions()));
  JudgeConvergence(settings, field, false);
}

PublishedModel::PublishedModel(
  const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, int channels)
  : ChannelCount(std::max(channels, ChannelsOf(medium, illumination)))
  , Isotropic(medium.phase.IsIsotropic())
{
  Check(Domain(medium.grid), medium, illumination, settings);
  CheckPublished(medium, illumination);
  this->Set = PublishedDirections(settings.directionsPerFace);
  this->BoundaryRadiances = BoundaryOf(this->Set, illumination, settings.periodic);
  if (settings.storedDirections == 1)
  {
    this->Stored = { { 0.0, 0.0, 0.0 } };
    this->Sources = EvenDirections(6);
  }
  else
  {
    this->Stored = this->Sources = EvenDirections(settings.storedDirections);
  }
  std::vector<double> fluence;
  for (const Direction& direction : this->Set.directions)
  {
    this->NearestSource.push_back(NearestOf(this->Sources, direction.omega));
    fluence.push_back(direction.weight);
  }
  this->Coefficients.push_back(fluence);
  if (!this->Isotropic)
  {
    for (std::vector<double>& row : ScatteringFactors(medium.phase.OfChannel(0), this->Set, this->Sources))
    {
      this->Coefficients.push_back(std::move(row));
    }
  }
  this->FirstFlux = this->MomentCount();
  for (int axis = 0; axis < 3 && settings.netFlux; ++axis)
  {
    std::vector<double> flux;
    for (const Direction& direction : this->Set.directions)
    {
      flux.push_back(direction.weight * direction.omega[axis]);
    }
    this->Coefficients.push_back(flux);
  }
}

std::vector<double> PublishedModel::MomentsAlong(const std::array<double, 3>& mean) const
{
  const double along = std::min(std::hypot(mean[0], mean[1], mean[2]), 1.0);
  const auto cosine = [&](const Direction& direction) {
    return mean[0] * direction.omega[0] + mean[1] * direction.omega[1] + mean[2] * direction.omega[2];
  };
  const std::vector<Direction>& all = this->Set.directions;
  const auto nearest = std::max_element(
    all.begin(), all.end(), [&](const Direction& a, const Direction& b) { return cosine(a) < cosine(b); });
  std::vector<double> moments;
  for (int k = 0; k < this->MomentCount(); ++k)
  {
    double evenly = 0.0;
    for (std::size_t i = 0; i < all.size() && along < 1.0; ++i)
    {
      evenly += this->Coefficient(k, static_cast<int>(i)) / FourPi;
    }
    const double there = this->Coefficient(k, static_cast<int>(nearest - all.begin())) / nearest->weight;
    moments.push_back(along * there + (1.0 - along) * evenly);
  }
  for (int axis = 0; axis < 3 && this->MomentCount() > this->FirstFlux; ++axis)
  {
    moments[this->FirstFlux + axis] = mean[axis];
  }
  return moments;
}

PublishedModel::Part PublishedModel::Source(int sourceDirection) const
{
  return this->Isotropic ? Part{ 0, 1.0 / FourPi } : Part{ 1 + sourceDirection, 1.0 };
}

PublishedModel::Part PublishedModel::ScatteredRadiance(int storedDirection) const
{
  return this->Stored.size() == 1 ? Part{ 0, 1.0 / FourPi } : this->Source(storedDirection);
}

MapGeometry::MapGeometry(
  const Grid& grid, const PropagationSettings& settings, const Direction& direction, int index, int perFace)
{
  this->axis = index / perFace / 2;
  this->axisU = AcrossAxis(this->axis).u;
  this->axisV = AcrossAxis(this->axis).v;
  this->planes = grid.size[this->axis];
  this->sizeU = grid.size[this->axisU];
  this->sizeV = grid.size[this->axisV];
  const std::array<double, 3>& omega = direction.omega;
  const double cosine = std::abs(omega[this->axis]);
  const double height = grid.spacing[this->axis];
  const double elements = static_cast<double>(settings.mapResolution) * settings.mapResolution;
  this->forward = omega[this->axis] > 0.0;
  this->slopeU = omega[this->axisU] / cosine * (height / grid.spacing[this->axisU]);
  this->slopeV = omega[this->axisV] / cosine * (height / grid.spacing[this->axisV]);
  this->length = height / cosine;
  this->beamPower = direction.weight * cosine * grid.spacing[this->axisU] * grid.spacing[this->axisV] / elements;
  this->density = cosine / (height * elements);
  for (int a = 0; a < 3; ++a)
  {
    this->Upward[a] = omega[a] >= 0.0;
  }
  this->Continues = settings.periodic[this->axis];
}

double MapGeometry::StartOfOrder(double start, double slope, int order) const
{
  if (order == 0 || !this->Continues)
  {
    return start;
  }
  const double position = start + slope * this->planes * order;
  const double place = position - std::floor(position);
  const bool onBorder = std::min(place, 1.0 - place) < 1e-9; // the ray has not yet crossed into the next voxel
  return !onBorder ? place : slope > 0.0 ? 1.0 : slope < 0.0 ? 0.0 : start;
}

GridWalk MapGeometry::Walk(int resolution, int subMap, int order) const
{
  const int column = subMap % resolution;
  const int row = subMap / resolution;
  return { this->StartOfOrder((column + 0.5) / resolution, this->slopeU, order),
    this->StartOfOrder((row + 0.5) / resolution, this->slopeV, order), this->slopeU, this->slopeV, this->planes };
}

GridWalk::GridWalk(double startU, double startV, double slopeU, double slopeV, int planes)
  : Planes(planes)
  , SignU(slopeU < 0.0 ? -1 : 1)
  , SignV(slopeV < 0.0 ? -1 : 1)
{
  const auto never = std::numeric_limits<double>::infinity();
  this->StepU = slopeU != 0.0 ? 1.0 / std::abs(slopeU) : never;
  this->StepV = slopeV != 0.0 ? 1.0 / std::abs(slopeV) : never;
  this->NextU = slopeU != 0.0 ? (slopeU > 0.0 ? 1.0 - startU : startU) * this->StepU : never;
  this->NextV = slopeV != 0.0 ? (slopeV > 0.0 ? 1.0 - startV : startV) * this->StepV : never;
}

bool GridWalk::Next()
{
  constexpr double together = 1e-9;
  this->moveU = this->moveV = 0;
  if (this->plane < 0)
  {
    this->plane = 0;
  }
  else
  {
    const bool ahead = this->plane + 1 <= this->Depth + together;
    if (ahead && this->plane + 1 == this->Planes)
    {
      return false;
    }
    this->plane += ahead ? 1 : 0;
    if (this->NextU <= this->Depth + together)
    {
      this->moveU = this->SignU;
      this->NextU += this->StepU;
    }
    if (this->NextV <= this->Depth + together)
    {
      this->moveV = this->SignV;
      this->NextV += this->StepV;
    }
  }
  const double end = std::min({ this->NextU, this->NextV, this->plane + 1.0 });
  this->fraction = std::max(0.0, end - this->Depth);
  this->Depth = std::max(this->Depth, end);
  return true;
}
}
