#include "Estimators.h"
namespace tyndall
{
void ReconstructByLevel(
  const Reconstruction&, const LentArray<float>&, const LentArray<float>&, double, ReconstructedLight&)
{
}
}
