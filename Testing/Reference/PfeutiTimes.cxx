#include "Reference/PfeutiTimes.h"

#include "Reference/ReferenceTable.h"

#include <stdexcept>

PfeutiPasses PfeutiPassesOf(const std::string& scene, const std::string& pipeline)
{
  for (const ReferenceRow& row : ReadReference("pfeuti_pass_times"))
  {
    if (row.Text("scene") == scene && row.Text("pipeline") == pipeline)
    {
      const auto pass = [&](const char* name) { return row.Text(name).empty() ? 0.0 : row[name]; };
      return { static_cast<std::size_t>(row["photons"]), pass("voxelisation"), pass("octree"), pass("pilot"),
        pass("generation"), pass("marching"), pass("reconstruction"), pass("viewing") };
    }
  }
  throw std::runtime_error("pfeuti_pass_times.csv does not have the " + pipeline + " pipeline of the " + scene);
}

std::string PfeutiMarchingTimes(const std::string& sampler)
{
  for (const ReferenceRow& row : ReadReference("pfeuti_sampler_times"))
  {
    if (row.Text("sampler") == sampler)
    {
      const std::string& columns = row.Text("columns_first");
      return row.Text("ms") + (columns.empty() ? "" : ", " + columns);
    }
  }
  throw std::runtime_error("pfeuti_sampler_times.csv does not have " + sampler);
}
