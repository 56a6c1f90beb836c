#include "Reference/StepCloudReference.h"

#include "Reference/ReferenceTable.h"

#include <stdexcept>
#include <string>

namespace step_cloud
{
namespace
{
/// Puts the consensus, or the own value and its error, of R or T.
void Put(const ReferenceRow& row, const std::string& quantity, double& value, double& error)
{
  const bool agreed = !row.Text(quantity + "_cons").empty();
  value = row[quantity + (agreed ? "_cons" : "_own")];
  error = agreed ? 0.0 : row[quantity + "_std"];
}
}

Experiment ExperimentOf(int number)
{
  Experiment experiment = {};
  int found = 0;
  for (const ReferenceRow& row : ReadReference("i3rc_step_cloud"))
  {
    if (row["exp"] != number)
    {
      continue;
    }
    experiment.sunFromZenith = row["sza"];
    experiment.albedo = row["omega"];
    Column& column = experiment.columns.at(static_cast<std::size_t>(row["col"]));
    Put(row, "R", column.reflected, column.reflectedError);
    Put(row, "T", column.transmitted, column.transmittedError);
    ++found;
  }
  if (found != Columns)
  {
    throw std::runtime_error("i3rc_step_cloud.csv has " + std::to_string(found) + " columns of experiment " +
      std::to_string(number) + " instead of 32");
  }
  return experiment;
}
}
