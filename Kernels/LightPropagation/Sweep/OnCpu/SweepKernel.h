#pragma once

#include "Device/Monitor.h"
#include "LightPropagation/Sweep/SweepPlan.h"

namespace tyndall
{
/// Kernel `sweep` (OnCpu/Sweep.cl) for a sweep plan, with its arguments and the device arrays that describe the plan's
/// rays.
class SweepKernel
{
public:
  /// @param plan  plan of the sweep; must outlive this object
  SweepKernel(Device& device, const SweepPlan& plan);

  /// Sets the incident light that is uniform over each face parallel to the marching axis.
  /// @param outside, radiance  power of the rays that enter through the faces normal to v (outside) and normal to u
  ///   (radiance), W, in the layout of SweepBorder
  void SetBorder(const std::vector<float>& outside, const std::vector<float>& radiance);
  void ClearBorder();
  bool IsBorderClear() const { return this->BorderIsClear; }
  /// Sets the path integrals that a unit source in a voxel causes within that voxel (SweepPlan::OwnLight).
  void SetOwnLight(const std::vector<OwnLightInfo>& own);

  /// Arguments of one or several launches of the kernel.
  struct Crossing
  {
    SweepInfo info; ///< arguments of the launch except its index
    VolumeArrays volume;
    const Buffer<float>& maps;
    const Buffer<float>& scratch;
    const Buffer<CrossingInfo>& crossings;
    /// Range of planes (first, end) that each work-item crosses, [launch][work-item]; if the volume is streamed, also
    /// the slot of each range (SliceStream::Schedule::rows)
    const Buffer<cl_int2>& schedule;
    /// Incident radiance per cell of the faces, or power of the rays that enter through the sides (Sweep.cl)
    const cl::Buffer& entering;
    const cl::Buffer& leaving;
    double secondsPerLaunch;
  };
  /// Arguments of the kernel that depend only on the plan and the volume.
  /// @param goesRound  whether rays wrap around the marching axis
  SweepInfo InfoOf(const SweepVolume& volume, bool goesRound) const;
  /// Compiles the kernel. The parameters are its compiler options FACES, PERIODIC and SIDES (SweepLayout.cl).
  cl::Kernel Make(bool faces, bool periodic, bool sides) const;
  /// Queues a launch of the kernel.
  /// @param launch  index in the schedule
  /// @param after  events to wait for; null: none
  /// @param done  signalled at the end of the launch; null: not needed
  void Launch(cl::Kernel& kernel, Crossing& crossing, int launch, const std::vector<cl::Event>* after = nullptr,
    cl::Event* done = nullptr) const;

  /// Power that escaped through the faces parallel to the marching axis in the launches so far, W,
  /// [plane][work-item][-u, +u, -v, +v][channel].
  std::vector<float> Sideways() const { return this->Left.Read(); }

private:
  Device& TheDevice;
  const SweepPlan& Plan;
  /// Incident power, W: the argument `outside` of SetBorder() for both senses of marching, then its argument `radiance`
  Buffer<float> Border;
  bool BorderIsClear = false;
  Buffer<float> Left, Coefficients;
  Buffer<BundleInfo> Bundles;
  Buffer<UnitInfo> Units;
  Buffer<OwnLightInfo> OwnLight;
  Buffer<cl_int> FunctionPlaces;
};
}
