#include "Reconstruction/ConservativeReconstruction.h"

#include "Reconstruction/ConservativePasses.h"

namespace tyndall
{
void ReconstructConservative(const Reconstruction& task, ReconstructedLight& result)
{
  ConservativePasses passes(task, result);
  passes.Build();
  passes.Begin();
  passes.Refine(task.levels - 1, 0);
  passes.Finish(task.Conserve(passes.Totals(), result));
}
}
