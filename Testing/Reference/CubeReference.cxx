#include "Reference/CubeReference.h"

#include "Reference/ReferenceTable.h"

#include <stdexcept>
#include <string>

namespace
{
CubeReference ReadCube(const std::string& name)
{
  const std::vector<ReferenceRow> rows = ReadReference(name);
  CubeReference cube = {};
  if (rows.size() != cube.size())
  {
    throw std::runtime_error(name + ".csv has " + std::to_string(rows.size()) + " rows instead of 1000");
  }
  for (std::size_t i = 0; i < cube.size(); ++i)
  {
    if (rows[i]["ix"] + 10.0 * rows[i]["iy"] + 100.0 * rows[i]["iz"] != static_cast<double>(i))
    {
      throw std::runtime_error(name + ".csv is not in the order of voxels, x fastest: row " + std::to_string(i));
    }
    cube[i] = { rows[i]["phi"], rows[i]["sigma"] };
  }
  return cube;
}
}

CubeReference CubeInDiffuseLight()
{
  return ReadCube("cube_fluence_tau1_w0.9_g0_diffuse");
}

CubeReference ShiningCube()
{
  return ReadCube("cube_fluence_tau5_w0.9_g0_volume");
}

CubePowers CubePowersOf(double tau, double albedo)
{
  const ReferenceRow row =
    ReferenceRowWhere("cube_RTSA", { { "tau", tau }, { "omega", albedo }, { "g", 0.0 }, { "src", 0.0 } });
  return { { row["R"], row["T"], row["S"], row["A"] }, { row["sR"], row["sT"], row["sS"], row["sA"] } };
}
