#pragma once

#include "Device/Monitor.h"
#include "LightPropagation/Sweep/SweepPlan.h"

#include <functional>

namespace tyndall
{
/// The kernel `sweep` (Sweep.cl) for a plan: the arrays on the device that describe the plan's rays, and its arguments.
class SweepKernel
{
public:
  /// @param plan  must outlive this object
  SweepKernel(Device& device, const SweepPlan& plan);

  /// Sets the incident light that is uniform over each face the rays pass sideways; both as in SweepBorder.
  void SetBorder(const std::vector<float>& outside, const std::vector<float>& radiance);
  void ClearBorder();
  bool IsBorderClear() const { return this->BorderIsClear; }
  void SetOwnLight(const std::vector<OwnLightInfo>& own); ///< see SweepPlan::OwnLight

  /// What one or several launches cross.
  struct Crossing
  {
    SweepInfo info; ///< without the index of the launch
    VolumeArrays volume;
    const Buffer<float>& maps;
    const Buffer<float>& scratch;
    const Buffer<CrossingInfo>& crossings;
    const Buffer<cl_int2>& schedule; ///< [launch][unit] planes from, to; if streamed see SliceStream::Schedule
    const cl::Buffer& entering;      ///< light by cells of the faces, or rays at the sides (Sweep.cl)
    const cl::Buffer& leaving;
    double secondsPerLaunch;
  };
  /// The launch's data that depend only on plan and volume.
  SweepInfo InfoOf(const SweepVolume& volume, bool goesRound) const;
  /// The parameters are the compiler options FACES, PERIODIC and SIDES (SweepLayout.cl).
  cl::Kernel Make(bool faces, bool periodic, bool sides) const;
  /// Queues a launch. @param after  events to wait for; null: none. @param done  signalled at its end; null: not needed
  void Launch(cl::Kernel& kernel, Crossing& crossing, int launch, const std::vector<cl::Event>* after = nullptr,
    cl::Event* done = nullptr) const;

  /// Power that left sideways in the launches so far, W: [plane][unit][-u, +u, -v, +v][channel].
  std::vector<float> Sideways() const { return this->Left.Read(); }

private:
  Device& TheDevice;
  const SweepPlan& Plan;
  Buffer<float> Border; ///< outside, then radiance, of both ways
  bool BorderIsClear = false;
  Buffer<float> Left, Coefficients;
  Buffer<BundleInfo> Bundles;
  Buffer<UnitInfo> Units;
  Buffer<OwnLightInfo> OwnLight;
  Buffer<cl_int> FunctionPlaces;
};
}
