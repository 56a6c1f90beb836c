#include "Viewing/Scene/ViewTraits.h"

#include "Device/Device.h"
#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"
#include "Numerics/Vectors.h"

#include <algorithm>
#include <glm/vec3.hpp>

namespace tyndall
{
namespace
{
/// Dilates a set of bricks by one brick in both directions of one axis.
std::vector<unsigned char> Widened(const std::vector<unsigned char>& bricks, const std::array<int, 3>& count, int axis)
{
  const std::size_t stride = axis == 0 ? 1
    : axis == 1                        ? static_cast<std::size_t>(count[0])
                                       : static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]);
  std::vector<unsigned char> wide = bricks;
  for (std::size_t brick = 0; brick < bricks.size(); ++brick)
  {
    const auto place = static_cast<int>(brick / stride % static_cast<std::size_t>(count[axis]));
    wide[brick] |= place > 0 ? bricks[brick - stride] : 0;
    wide[brick] |= place + 1 < count[axis] ? bricks[brick + stride] : 0;
  }
  return wide;
}
}

SeenBricks SeenBricksOf(const FilledBricks& filled, bool everywhere)
{
  SeenBricks bricks;
  bricks.count = filled.count;
  if (everywhere)
  {
    bricks.seen.assign(filled.filled.size(), 1);
    return bricks;
  }
  bricks.seen = filled.filled;
  for (int axis = 0; axis < 3; ++axis) // dilation along the three axes in succession also includes diagonal neighbours
  {
    bricks.seen = Widened(bricks.seen, filled.count, axis);
  }
  bricks.all = std::count(bricks.seen.begin(), bricks.seen.end(), 0) == 0;
  return bricks;
}

namespace
{
using Kind = PhaseFunction::Kind;
using Functions = std::array<PhaseFunction, 3>;

/// Number of Legendre moments of phase functions without a formula; resolves 0.2 degrees.
constexpr int MomentCount = 1024;
/// Terms of numerics.md, Eq. (108a), are proportional to a^l, where a is the length of the light's mean direction. They
/// are dropped where a^l falls below this value.
constexpr double NoMore = 1e-7;
/// Fraction of the scattered light that the quadrature for the Legendre moments may miss.
constexpr double Resolved = 1e-6;
constexpr int RowLength = CosineRows + 2;

bool AllOf(const Functions& functions, std::initializer_list<Kind> kinds)
{
  return std::all_of(functions.begin(), functions.end(), [&](const PhaseFunction& function) {
    return std::find(kinds.begin(), kinds.end(), function.TheKind()) != kinds.end();
  });
}

ViewedPhase::Formula FormulaOf(const Functions& functions)
{
  return std::all_of(functions.begin(), functions.end(), [](const PhaseFunction& f) { return f.IsIsotropic(); })
    ? ViewedPhase::Even
    : AllOf(functions, { Kind::Isotropic, Kind::HenyeyGreenstein }) ? ViewedPhase::HenyeyGreenstein
    : AllOf(functions, { Kind::Isotropic, Kind::Schlick })          ? ViewedPhase::Schlick
    : AllOf(functions, { Kind::Isotropic, Kind::HenyeyGreenstein, Kind::DoubleHenyeyGreenstein })
    ? ViewedPhase::TwoLobes
    : AllOf(functions, { Kind::Rayleigh }) ? ViewedPhase::Rayleigh
                                           : ViewedPhase::Rows;
}

/// Table of k / g as a function of sqrt(1 - g), where k is the parameter of Schlick's function with mean cosine g.
std::vector<float> RowsOfSchlick()
{
  std::vector<float> rows;
  for (int row = 0; row <= SchlickRows; ++row)
  {
    const double aside = static_cast<double>(row) / SchlickRows;
    const double g = 1.0 - aside * aside;
    rows.push_back(static_cast<float>(row == 0 ? 1.0
        : row == SchlickRows                   ? 1.5
                                               : PhaseFunction::Schlick(g).Shape().first / g));
  }
  rows.push_back(rows.back());
  return rows;
}

/// Cosine of the scattering angle of a table entry, as in PhaseFunction.cl.
double CosineOfRow(int row)
{
  const double aside = 2.0 * std::min(row, CosineRows - row) / CosineRows;
  return 2 * row < CosineRows ? 1.0 - aside * aside : aside * aside - 1.0;
}

/// (2 l + 1) times the Legendre moments of a phase function. The quadrature resolves all that the tables can show. The
/// part of a narrow peak that the quadrature misses is added as a beam in the forward direction.
std::vector<double> WeightedMoments(const PhaseFunction& function)
{
  static const GaussLegendre rule(MomentCount);
  std::vector<double> moments(MomentCount, 0.0);
  const auto add = [&](double part, double cosine) {
    const std::vector<double> p = LegendrePolynomials(MomentCount - 1, cosine);
    for (int l = 0; l < MomentCount; ++l)
    {
      moments[l] += part * p[l];
    }
  };
  for (std::size_t i = 0; i < rule.points.size(); ++i)
  {
    add(2.0 * Pi * rule.weights[i] * function.Value(rule.points[i]), rule.points[i]);
  }
  const double missed = 1.0 - moments[0];
  if (missed > Resolved)
  {
    add(missed, std::clamp((function.MeanCosine() - moments[1]) / missed, -1.0, 1.0));
  }
  for (int l = MomentCount - 1; l >= 0; --l)
  {
    moments[l] *= (2 * l + 1) / moments[0];
  }
  return moments;
}

/// Appends a table to `rows`: 4 pi times the phase function, averaged over light that is spread about its mean
/// direction. This is the sum of (2 l + 1) chi_l a^l P_l(c), numerics.md, Eq. (108a).
void AddSpreadRows(const PhaseFunction& function, std::vector<float>& rows)
{
  const std::vector<double> moments = WeightedMoments(function);
  std::vector<std::vector<double>> factors(SpreadRows + 1);
  for (int row = 1; row <= SpreadRows; ++row)
  {
    const double aside = static_cast<double>(row) / SpreadRows;
    double power = 1.0;
    for (int l = 0; l < MomentCount && power > NoMore; ++l, power *= 1.0 - aside * aside)
    {
      factors[row].push_back(moments[l] * power);
    }
  }
  const std::size_t first = rows.size();
  rows.resize(first + static_cast<std::size_t>(SpreadRows + 2) * RowLength);
  for (int column = 0; column < RowLength; ++column)
  {
    const double cosine = CosineOfRow(std::min<int>(column, CosineRows));
    const std::vector<double> p = LegendrePolynomials(MomentCount - 1, cosine);
    rows[first + column] = static_cast<float>(4.0 * Pi * function.Value(cosine)); // row 0: light of a single direction
    for (int row = 1; row <= SpreadRows + 1; ++row)
    {
      const std::vector<double>& factor = factors[std::min<int>(row, SpreadRows)];
      double sum = 0.0;
      for (std::size_t l = 0; l < factor.size(); ++l)
      {
        sum += factor[l] * p[l];
      }
      rows[first + static_cast<std::size_t>(row) * RowLength + column] = static_cast<float>(std::max(sum, 0.0));
    }
  }
}
}

ViewedPhase ViewedPhaseOf(const PhaseOfMedium& phase)
{
  const Functions functions = { phase.OfChannel(0), phase.OfChannel(1), phase.OfChannel(2) };
  ViewedPhase viewed;
  viewed.varies = phase.Varies();
  viewed.channels = phase.HasColour() ? 3 : 1;
  viewed.formula = !viewed.varies             ? FormulaOf(functions)
    : functions[0].TheKind() == Kind::Schlick ? ViewedPhase::Schlick
                                              : ViewedPhase::HenyeyGreenstein;
  glm::dvec3 first, second, part;
  for (int c = 0; c < 3; ++c)
  {
    const PhaseFunction::Parameters& shape = functions[c].Shape();
    first[c] = viewed.formula == ViewedPhase::Schlick ? functions[c].MeanCosine() : shape.first;
    second[c] = shape.second;
    part[c] = shape.part;
  }
  viewed.parameters = { Float4(first), Float4(second), Float4(part) };
  return viewed;
}

std::vector<float> RowsOf(const ViewedPhase& viewed, const PhaseOfMedium& phase)
{
  if (viewed.formula == ViewedPhase::Schlick)
  {
    return RowsOfSchlick();
  }
  std::vector<float> rows;
  for (int c = 0; c < viewed.channels && viewed.formula == ViewedPhase::Rows; ++c)
  {
    AddSpreadRows(phase.OfChannel(c), rows);
  }
  return rows;
}

namespace
{
/// Samples are stored in bricks if at most this fraction of bricks is filled. Otherwise the samples duplicated at brick
/// faces would cost more memory than empty bricks save.
constexpr double FilledAtMost = 0.25;

void FindMoments(const PhaseOfMedium& phase, const SolvedLight& light, ViewTraits& traits)
{
  if (!traits.ShowsMoments())
  {
    return;
  }
  traits.moments.channels =
    light.scatteredMoments.components / ((traits.moments.degree + 1) * (traits.moments.degree + 1));
  traits.moments.straightOnChannels = light.straightOn.components;
  traits.moments.aureoleChannels = traits.shadowRays && !phase.Varies() ? traits.phase.channels : 0;
}

/// For each of ViewedFields (absorption to fluenceDirect), number of components that the picture reads; 0: it reads
/// none.
std::array<int, 5> ComponentsRead(const std::array<Field, 5>& fields, const ViewTraits& traits)
{
  const bool shadows = traits.shadowRays;
  const bool single = traits.singleScatteringOnly;
  const bool all = !traits.leaveOut;
  const std::array<bool, 5> used = { all || traits.medium.absorbs, all || traits.medium.scatters,
    all || traits.medium.emits, !single && !traits.ShowsMoments(), shadows != single && !traits.ShowsMoments() };
  std::array<int, 5> components = {};
  for (std::size_t i = 0; i < fields.size(); ++i)
  {
    components[i] = used[i] && fields[i].values ? fields[i].components : 0;
  }
  return components;
}
}

int ShownDegree(const SolvedLight& light, const ViewSettings& settings)
{
  return light.scatteredMoments.values && !settings.singleScatteringOnly ? DegreeOf(light.scatteredMoments) : -1;
}

std::array<Field, 5> ViewedFields(const Medium& medium, const SolvedLight& light)
{
  return { medium.sigma_a, medium.sigma_s, medium.emission, light.fluence, light.fluenceDirect };
}

ViewTraits ViewTraitsOf(const Medium& medium, const FilledBricks& filled, const SolvedLight& light, const Field& ior,
  const ViewSettings& settings, int kernelWidth, const SharedScene* shared)
{
  ViewTraits traits;
  traits.grid = medium.grid;
  traits.packetWidth = settings.packetWidth > 0 ? settings.packetWidth : kernelWidth;
  traits.leaveOut = settings.leaveOut;
  traits.singleScatteringOnly = settings.singleScatteringOnly;
  traits.shadowRays = settings.shadowRays;
  traits.hasTable = settings.tableFace >= 0;
  traits.medium = TraitsOf(medium, filled);
  traits.largestSigmaT = static_cast<double>(filled.absorption.largest) + filled.scattering.largest;
  traits.phase = ViewedPhaseOf(medium.phase);
  traits.index = shared ? shared->index : IndexRangeOf(ior, medium.grid);
  traits.bends = !settings.leaveOut || traits.index.Varies();
  traits.bricks = SeenBricksOf(filled, traits.bends || !traits.SkipsBricks(settings));
  traits.moments.degree = ShownDegree(light, settings);
  FindMoments(medium.phase, light, traits);

  const bool anisotropic = traits.phase.formula != ViewedPhase::Even;
  traits.knowsFlow =
    anisotropic && light.meanDirection.values && light.fluence.values && !settings.shadowRays && !traits.ShowsMoments();
  traits.coloured = !settings.leaveOut || !traits.medium.greyExtinction || traits.moments.straightOnChannels == 3 ||
    (shared && shared->coloured);
  // Samples with one channel do not pay off if the light's directions are read as well.
  traits.grey = !traits.coloured && traits.medium.grey && !traits.knowsFlow && !traits.shadowRays &&
    !traits.ShowsMoments() && light.fluence.components == 1 && light.fluenceDirect.components == 1 &&
    (!traits.medium.emits || traits.medium.emission.IsGrey());
  for (int c = 0; c < traits.moments.aureoleChannels; ++c)
  {
    traits.moments.straightOn[c] = shared ? shared->straightOn[c] : LeastStraightOn(medium, light, c);
  }
  traits.sourcesDependOnCamera = (traits.shadowRays && anisotropic) || traits.ShowsMoments();
  traits.components = ComponentsRead(ViewedFields(medium, light), traits);
  // Samples for shadow rays or moments are not stored in bricks, since their light is stored in the order of voxels.
  traits.bricked =
    !shared && traits.OnlyStraight() && traits.PacksOnce() && !traits.bricks.all && filled.FilledPart() <= FilledAtMost;
  return traits;
}

bool ViewTraits::Reflects(const ViewSettings& settings) const
{
  return this->bends && settings.surfaceReflection != SurfaceReflection::None &&
    this->SurfaceIndex(settings) > this->index.least && this->SurfaceIndex(settings) <= this->index.largest;
}

std::string ViewTraits::PacketOptions() const
{
  return Define("REAL_WIDTH", this->packetWidth) + this->SampleOptions();
}

std::string ViewTraits::SampleOptions() const
{
  return Define("COLOURED", this->coloured) + Define("GREY", this->grey) + Define("BRICKED", this->bricked);
}

ViewedComponents ViewTraits::Components() const
{
  const std::array<int, 5>& of = this->components;
  return { of[0], of[1], of[2], of[3], of[4], this->ReadsMeanCosines() ? this->phase.channels : 0,
    this->moments.straightOnChannels, 0 };
}

std::string ViewTraits::PhaseOptions(bool needed) const
{
  return Define("PHASE", needed ? static_cast<int>(this->phase.formula) : 0) +
    Define("PHASE_CHANNELS", this->phase.channels) + Define("FLOW", this->Flow());
}
}
