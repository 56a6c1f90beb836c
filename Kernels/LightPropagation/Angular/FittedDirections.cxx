#include "LightPropagation/Angular/DirectionSet.h"

#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tyndall
{
namespace
{
/// Tabulated orbits of a fitted quadrature. Weights are relative to the weight 4 pi / (number of directions) of a
/// uniform quadrature (numerics.md, Eq. (16a)).
struct FittedSet
{
  int perFace;
  std::vector<DirectionOrbit> orbits;
};

const std::vector<FittedSet>& FittedSets()
{
  // clang-format off
  static const std::vector<FittedSet> sets = {
  { 9,
    {
      { 0.0, 0.0, 1.432710276633, 0.00374 },
      { 0.297032884030, 0.637446040955, 0.945911215421, -0.00374 },
    } },
  { 16,
    {
      { 0.218396425934, 0.218396425934, 1.344708932060, 0.00254 },
      { 0.596508597386, 0.596508597386, 1.395466977797, 0.00300 },
      { 0.053270521082, 0.749164075077, 0.629912045071, -0.00554 },
    } },
  { 25,
    {
      { 0.0, 0.0, 1.038656103312, -0.00366 },
      { 0.168867115483, 0.318307264566, 1.003088761088, 0.00028 },
      { 0.093286362535, 0.708283733235, 0.836512814257, 0.00039 },
      { 0.492365876129, 0.732865960442, 1.155566411741, 0.00299 },
    } },
  { 36,
    {
      { 0.104217097935, 0.104217097935, 1.055573346091, -0.00224 },
      { 0.273551551561, 0.386208692080, 1.071476897203, 0.00125 },
      { 0.029066777105, 0.521165569950, 0.825981809964, 0.00259 },
      { 0.569853676999, 0.792125054823, 1.067939906274, -0.00068 },
      { 0.229539333709, 0.824737377430, 1.006814713513, -0.00093 },
    } },
  { 49,
    {
      { 0.0, 0.0, 1.012011440988, -0.00216 },
      { 0.100786002404, 0.228626940341, 0.974852289714, -0.00018 },
      { 0.137933860122, 0.434923156683, 1.009705194118, -0.00027 },
      { 0.343575187795, 0.492292707701, 1.073605790196, 0.00067 },
      { 0.044241847299, 0.750601596534, 0.881386739535, 0.00117 },
      { 0.644233450633, 0.795652566456, 0.989143177837, 0.00022 },
      { 0.318896639551, 0.811414796307, 1.069805378476, 0.00055 },
    } },
  { 64,
    {
      { 0.068480446449, 0.164557886926, 0.934144803957, -0.00079 },
      { 0.261460969784, 0.356926447553, 0.989234873776, 0.00039 },
      { 0.095889100681, 0.388115803939, 1.011367355607, -0.00026 },
      { 0.198764251906, 0.578513755134, 0.998921686323, -0.00042 },
      { 0.429423928825, 0.612650888362, 0.983172662297, -0.00080 },
      { 0.679075933893, 0.775564707220, 1.049672572073, 0.00071 },
      { 0.025188417947, 0.790143826612, 1.008702047655, 0.00208 },
      { 0.342393118090, 0.865502191340, 1.024783998313, -0.00091 },
    } },
  { 100,
    {
      { 0.029885395676, 0.152941072422, 0.999892424658, 0.00029 },
      { 0.152728431096, 0.279119758995, 0.996320526407, 0.00023 },
      { 0.051419673599, 0.349493496226, 0.998133467444, 0.00023 },
      { 0.268558911856, 0.360427764627, 1.008238691271, 0.00012 },
      { 0.203667754143, 0.519095119037, 1.000818445034, -0.00057 },
      { 0.394708746704, 0.569593539913, 1.001931733646, -0.00027 },
      { 0.0, 0.599932826437, 0.997096056864, 0.00024 },
      { 0.522216947655, 0.661235121809, 0.996330123453, 0.00056 },
      { 0.109938077096, 0.675831127521, 0.996438262176, 0.00048 },
      { 0.275711024247, 0.730667974102, 1.001685319108, -0.00036 },
      { 0.713658361464, 0.816630650912, 1.000705551474, -0.00011 },
      { 0.465099865353, 0.901302473413, 0.992690935126, -0.00044 },
      { 0.132323711527, 0.914446298698, 1.008266491771, -0.00041 },
    } },
  };
  // clang-format on
  return sets;
}

/// The 1, 4 or 8 points (s, t) of one face of the cube, -1 to 1, through which the directions of an orbit pass.
std::vector<std::array<double, 2>> TangentsOf(const DirectionOrbit& orbit)
{
  std::vector<std::array<double, 2>> all;
  for (const std::array<double, 2>& one :
    { std::array<double, 2>{ orbit.across, orbit.along }, { orbit.along, orbit.across } })
  {
    for (const double signS : { -1.0, 1.0 })
    {
      for (const double signT : { -1.0, 1.0 })
      {
        const std::array<double, 2> tangents = { one[0] == 0.0 ? 0.0 : signS * one[0],
          one[1] == 0.0 ? 0.0 : signT * one[1] };
        if (std::find(all.begin(), all.end(), tangents) == all.end())
        {
          all.push_back(tangents);
        }
      }
    }
  }
  return all;
}

DirectionSet Build(const FittedSet& fitted)
{
  DirectionSet set;
  set.cellsPerEdge = static_cast<int>(std::lround(std::sqrt(static_cast<double>(fitted.perFace))));
  set.orbits = fitted.orbits;
  double all = 0.0;
  for (const DirectionOrbit& orbit : set.orbits)
  {
    all += orbit.weight * static_cast<double>(TangentsOf(orbit).size());
  }
  std::vector<double> weights;
  for (DirectionOrbit& orbit : set.orbits)
  {
    orbit.weight *= 4.0 * Pi / (6.0 * all);
    for (const std::array<double, 2>& tangents : TangentsOf(orbit))
    {
      set.tangents.push_back(tangents);
      weights.push_back(orbit.weight);
    }
  }
  for (int face = 0; face < 6; ++face)
  {
    for (std::size_t i = 0; i < set.tangents.size(); ++i)
    {
      set.directions.push_back({ DirectionThroughFace(face, set.tangents[i][0], set.tangents[i][1]), weights[i] });
    }
  }
  return set;
}
}

DirectionSet FittedDirections(int perFace, const std::string& name)
{
  for (const FittedSet& fitted : FittedSets())
  {
    if (fitted.perFace == perFace)
    {
      return Build(fitted);
    }
  }
  return EquiangularDirections(perFace, name);
}

DirectionSet DirectionsForVoxels(int perFace, const std::array<double, 3>& spacing)
{
  constexpr double Longer = 100.0;
  const auto [least, most] = std::minmax_element(spacing.begin(), spacing.end());
  return *most > Longer * *least ? EquiangularDirections(perFace) : FittedDirections(perFace);
}
}
