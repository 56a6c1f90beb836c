#include "LightPropagation/PlaneParallel/PlaneParallelPropagation.h"

#include "Device/Clock.h"
#include "Light/ChannelReduction.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/PlaneParallel/SlabScene.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr int MostLayers = 8192; ///< largest number of layers; about 200 MB of operators if all differ

/// Whether a field is constant within each layer perpendicular to an axis.
bool IsLayered(const Field& field, const Grid& grid, int axis)
{
  const std::size_t stride = grid.Strides()[axis], count = static_cast<std::size_t>(grid.size[axis]);
  const auto components = static_cast<std::size_t>(field.components);
  for (std::size_t i = 0; field.values && i < grid.VoxelCount(); ++i)
  {
    const float* const first = field.values + i / stride % count * stride * components;
    if (!std::equal(first, first + components, field.values + i * components))
    {
      return false;
    }
  }
  return true;
}

bool IsLayered(const Medium& medium, int axis)
{
  const Grid& grid = medium.grid;
  return IsLayered(medium.sigma_a, grid, axis) && IsLayered(medium.sigma_s, grid, axis) &&
    IsLayered(medium.emission, grid, axis) && IsLayered(medium.phase.G(), grid, axis);
}

constexpr int NodesIfIsotropic = 16, NodesElse = 20; ///< default number of nodes (cosines per hemisphere)
constexpr int DegreeForPictures = 9;                 ///< highest degree of LightField::scatteredMoments

int NodesFor(const SlabScene& scene, const PropagationSettings& settings)
{
  return settings.polarNodes > 0 ? settings.polarNodes : scene.IsIsotropic() ? NodesIfIsotropic : NodesElse;
}

bool KeepsMoments(const SlabScene& scene, const PropagationSettings& settings)
{
  return settings.storeMoments && !scene.IsIsotropic();
}

/// Highest order of the Fourier series in azimuth that must be solved; 0 for isotropic scattering.
int OrdersFor(const SlabScene& scene, const PropagationSettings& settings, int degree)
{
  return scene.IsIsotropic() || !scene.HasSlantingBeams() ? 0
    : KeepsMoments(scene, settings)                       ? std::min(degree, DegreeForPictures)
    : settings.netFlux                                    ? 1
                                                          : 0;
}

/// Outgoing radiance at SurfaceCosines: polynomial interpolation, in the square root of the cosine, of the radiance at
/// the quadrature's nodes.
std::array<double, SurfaceCosines.size()> AtSurfaceCosines(
  const HalfRangeQuadrature& nodes, const Eigen::VectorXd& radiance)
{
  std::array<double, SurfaceCosines.size()> at = {};
  for (std::size_t s = 0; s < at.size(); ++s)
  {
    const double x = std::sqrt(SurfaceCosines[s]);
    for (std::size_t i = 0; i < nodes.cosines.size(); ++i)
    {
      double part = radiance[static_cast<Eigen::Index>(i)] / std::sqrt(nodes.weights[i]);
      for (std::size_t j = 0; j < nodes.cosines.size(); ++j)
      {
        const double other = std::sqrt(nodes.cosines[j]);
        part *= j == i ? 1.0 : (x - other) / (std::sqrt(nodes.cosines[i]) - other);
      }
      at[s] += part;
    }
  }
  return at;
}

/// Solves a plane-parallel scene, one column of layers for each channel, and copies the result to all voxels of a
/// LightField.
class SlabLight
{
public:
  SlabLight(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, int channels)
    : TheMedium(medium)
    , Settings(settings)
    , Channels(channels)
    , KeepsFacePower(settings.facePower || Reflects(illumination))
    , Scene(medium, illumination, settings)
    , Nodes(NodesFor(this->Scene, settings))
    , Degree(this->Scene.IsIsotropic() ? 0 : static_cast<int>(this->Nodes.cosines.size()) - 1)
  {
  }

  LightField Solve(const Monitor& monitor)
  {
    const int orders = OrdersFor(this->Scene, this->Settings, this->Degree);
    for (int c = 0; c < this->Channels; ++c)
    {
      Report(monitor, 1.0 * c / this->Channels);
      this->Columns.emplace_back(this->Scene, c, this->Nodes, this->Degree, orders);
    }
    LightField light;
    light.channels = this->Channels;
    this->FillVoxels(light);
    this->FillFaces(light);
    this->FillMoments(light);
    this->Balance(light);
    light.halfRangeFlux.fill(1.0);
    light.polarNodes = static_cast<int>(this->Nodes.cosines.size());
    light.directionsPerFace = this->Settings.directionsPerFace;
    light.device = "host, one core";
    return light;
  }

private:
  void FillVoxels(LightField& light) const
  {
    const std::size_t voxels = this->TheMedium.grid.VoxelCount();
    const auto all = static_cast<std::size_t>(this->Channels);
    light.fluence.resize(voxels * all);
    light.fluenceDirect.resize(voxels * all);
    light.scatteredRadiance.resize(voxels * all);
    light.storedDirections = { { 0.0, 0.0, 0.0 } };
    light.netFlux.resize(this->Settings.netFlux ? 3 * voxels * all : 0);
    for (std::size_t i = 0; i < voxels * all; ++i)
    {
      const SlabColumn& column = this->Columns[i % all];
      const std::size_t layer = this->Scene.LayerOf(i / all);
      light.fluence[i] = static_cast<float>(std::max(column.fluence[layer], 0.0));
      light.fluenceDirect[i] = static_cast<float>(column.direct[layer]);
      // Computed from the fluence, in which negative values are set to 0: values around 1e-16 of the incident light are
      // differences of larger numbers, and may be negative.
      light.scatteredRadiance[i] = light.fluence[i] / (4.0f * static_cast<float>(Pi));
      for (int a = 0; a < 3 && this->Settings.netFlux; ++a)
      {
        light.netFlux[3 * i + static_cast<std::size_t>((this->Scene.Along() + a) % 3)] =
          static_cast<float>(column.flux[a][layer]);
      }
    }
  }

  void FillFaces(LightField& light) const
  {
    const Grid& grid = this->TheMedium.grid;
    const int along = this->Scene.Along();
    const auto all = static_cast<std::size_t>(this->Channels);
    light.facePower.resize(this->KeepsFacePower ? BoxFaceCellCount(grid) * all : 0);
    const bool thick = this->Scene.IsIsotropic() && this->IsThickAtSurface();
    light.surfaceRadiance.resize(thick ? BoxFaceCellCount(grid) * SurfaceCosines.size() * all : 0);
    const std::size_t cells = grid.VoxelCount() / static_cast<std::size_t>(grid.size[along]);
    for (int side = 0; side < 2; ++side)
    {
      const std::size_t first = LayoutOfFace(grid, 2 * along + side).first;
      for (std::size_t c = 0; c < all; ++c)
      {
        const SlabColumn& column = this->Columns[c];
        const auto radiance = AtSurfaceCosines(this->Nodes, side == 0 ? column.even.upAtTop : column.even.downAtBottom);
        for (std::size_t cell = first; cell < first + cells; ++cell)
        {
          for (std::size_t s = 0; s < SurfaceCosines.size() && thick; ++s)
          {
            light.surfaceRadiance[(cell * SurfaceCosines.size() + s) * all + c] =
              static_cast<float>(std::max(radiance[s], 0.0));
          }
          if (this->KeepsFacePower)
          {
            light.facePower[cell * all + c] = static_cast<float>(column.out[side]);
          }
        }
      }
    }
  }

  bool IsThickAtSurface() const
  {
    return std::any_of(this->Columns.begin(), this->Columns.end(), [](const SlabColumn& column) {
      return std::max(column.stack.layers.front().depth, column.stack.layers.back().depth) > ThickAtSurface;
    });
  }

  void FillMoments(LightField& light) const
  {
    if (!KeepsMoments(this->Scene, this->Settings))
    {
      return;
    }
    const int degree = std::min(this->Degree, DegreeForPictures);
    const auto harmonics = static_cast<std::size_t>((degree + 1) * (degree + 1));
    const auto all = static_cast<std::size_t>(this->Channels);
    const std::size_t voxels = this->TheMedium.grid.VoxelCount();
    light.scatteredMoments.resize(voxels * harmonics * all);
    light.straightOn.resize(voxels * all);
    for (std::size_t c = 0; c < all; ++c)
    {
      const SlabColumn& column = this->Columns[c];
      const std::vector<double> moments = ScatteredMoments(this->Scene, column, this->Nodes, degree);
      for (std::size_t i = 0; i < voxels; ++i)
      {
        const std::size_t layer = this->Scene.LayerOf(i);
        light.straightOn[i * all + c] =
          static_cast<float>(column.stack.kinds[column.stack.layers[layer].kind].phase.forward);
        for (std::size_t j = 0; j < harmonics; ++j)
        {
          light.scatteredMoments[(i * harmonics + j) * all + c] = static_cast<float>(moments[layer * harmonics + j]);
        }
      }
    }
  }

  void Balance(LightField& light) const
  {
    const double area = this->Scene.Across();
    double escaped = 0.0, absorbed = 0.0;
    for (std::size_t c = 0; c < this->Columns.size(); ++c)
    {
      const SlabColumn& column = this->Columns[c];
      light.balance.entered[c] = area * (column.entered[0] + column.entered[1]);
      light.balance.emitted[c] = area * column.emitted;
      light.balance.absorbed[c] = area * column.absorbed;
      light.balance.escaped[c] = area * (column.escaped[0] + column.escaped[1]);
      for (std::size_t side = 0; side < 2; ++side)
      {
        light.facePowerOut[2 * static_cast<std::size_t>(this->Scene.Along()) + side][c] =
          area * std::max(column.escaped[side], 0.0); // below 0 by rounding behind opaque layers
      }
      absorbed += light.balance.absorbed[c];
      escaped += light.balance.escaped[c];
    }
    ConvergenceRow row;
    row.iteration = 1;
    row.change = 1.0;
    row.absorbed = absorbed;
    row.escaped = escaped;
    light.convergence = { row };
  }

  const Medium& TheMedium;
  const PropagationSettings& Settings;
  int Channels;
  bool KeepsFacePower;
  SlabScene Scene;
  HalfRangeQuadrature Nodes;
  int Degree;
  std::vector<SlabColumn> Columns;
};

void SayWhatIsLeftOut(const PropagationSettings& settings, const MediumTraits& traits, LightField& light)
{
  const auto say = [&](bool condition, const std::string& text) {
    if (condition)
    {
      light.leftOut.push_back(text);
    }
  };
  say(true, left_out::TwoAxes(light.polarNodes));
  say(traits.isotropic && traits.scatters, left_out::Isotropic);
  say(!traits.scatters, left_out::NoScattering);
  say(!traits.absorbs, left_out::NoAbsorption);
  say(!traits.emits, left_out::NoEmission);
  say(!settings.netFlux, left_out::NetFlux);
}
}

int AxisOfLayers(const std::array<bool, 3>& periodic)
{
  int axis = -1, count = 0;
  for (int a = 0; a < 3; ++a)
  {
    axis = periodic[a] ? axis : a;
    count += periodic[a] ? 1 : 0;
  }
  return count == 2 ? axis : -1;
}

bool IsPlaneParallel(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
{
  const int axis = AxisOfLayers(settings.periodic);
  const bool asked = settings.source == PropagationSource::Automatic &&
    settings.acceleration == PropagationAcceleration::Automatic && settings.adaptDirections && settings.leaveOut &&
    settings.maximumOrders == 0 && settings.angularDegree < 0 && !settings.firstMoments;
  return axis >= 0 && medium.grid.size[axis] <= MostLayers && asked && !AnyHasPosition(illumination.lights) &&
    illumination.environment.Empty() && !illumination.uncollided.IsThere() && IsLayered(medium, axis);
}

LightField SolvePlaneParallel(
  const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, const Monitor& monitor)
{
  Check(Domain(medium.grid), medium, illumination, settings);
  // Throws if the number of directions is invalid, although that number is not used.
  EquiangularDirections(settings.directionsPerFace);
  const double start = ClockSeconds();
  const MediumTraits traits = TraitsOf(medium, true);
  LightField light = SolveChannels(settings.leaveOut, SceneChannels(medium, traits, illumination), medium, illumination,
    [&](const Medium& seen, const Illumination& shining, int channels) {
      return SlabLight(seen, shining, settings, channels).Solve(monitor);
    });
  SayWhatIsLeftOut(settings, traits, light);
  light.faceAlbedo = illumination.faceAlbedo;
  light.lampsApart = light.scatteredMoments.empty() ? std::vector<Light>() : illumination.lights;
  light.convergence.front().seconds = ClockSeconds() - start;
  return light;
}
}
