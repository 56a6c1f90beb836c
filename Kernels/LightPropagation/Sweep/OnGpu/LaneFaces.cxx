#include "LightPropagation/Sweep/OnGpu/LaneFaces.h"

#include "Device/Device.h"
#include "Device/Sizes.h"
#include "Medium/BoxFaces.h"
#include "TyndallKernelSources.h"

#include <algorithm>

namespace tyndall
{
LaneFaces::LaneFaces(Device& device, const GpuLanes& lanes, const Grid& grid, const SweepRequest& request)
  : TheDevice(device)
  , The(lanes)
  , FaceIn(request.faceIn)
  , FaceOut(request.deposit.faceOut)
  , Spreads(request.deposit.spreadsAside)
  , Cells(BoxFaceCellCount(grid))
{
  std::vector<LaneFaceInfo> faces;
  std::vector<cl_int2> rays;
  std::size_t sides = 0;
  for (const SweepLane& lane : lanes.lanes)
  {
    faces.push_back(this->FacesOf(lane, grid));
    for (int b = lane.firstBundle; b < lane.firstBundle + lane.bundles; ++b)
    {
      for (int member = 0; member < lanes.bundles[b].members; ++member)
      {
        rays.push_back({ { b, member } });
      }
    }
  }
  for (const LaneBatch& batch : lanes.batches)
  {
    sides = std::max(sides, batch.sides);
  }
  this->Faces = Buffer<LaneFaceInfo>(device, faces, "the box's faces");
  this->RayPlaces = Buffer<cl_int2>(device, rays, "the rays");
  const auto ofRays = [&](const char* what) {
    return Buffer<float>(device, sides, what, CL_MEM_READ_WRITE, Residence::Device);
  };
  this->SidesIn = ofRays("the light that comes in sideways");
  this->SidesOut = ofRays("the light that leaves sideways");
}

LaneFaceInfo LaneFaces::FacesOf(const SweepLane& lane, const Grid& grid) const
{
  const PlaneAxes axes = AcrossAxis(lane.axis);
  LaneFaceInfo info = {};
  for (int side = 0; side < 4; ++side)
  {
    const int aside = side < 2 ? axes.u : axes.v;
    const BoxFaceLayout layout = LayoutOfFace(grid, 2 * aside + side % 2);
    info.first[side] = static_cast<cl_int>(layout.first);
    info.plane[side] = static_cast<cl_int>(layout.step[lane.axis]);
    info.along[side] = static_cast<cl_int>(layout.step[side < 2 ? axes.v : axes.u]);
  }
  info.in = this->FaceIn != nullptr;
  info.spread = this->Spreads;
  info.start = static_cast<cl_int>(LayoutOfFace(grid, 2 * lane.axis + lane.backward).first);
  info.end = static_cast<cl_int>(LayoutOfFace(grid, 2 * lane.axis + 1 - lane.backward).first);
  return info;
}

cl::Kernel LaneFaces::Kernel(const char* name) const
{
  return this->TheDevice.Kernel(name, kernel_source::LaneFaces, Define("CHANNELS", this->The.channels));
}

std::size_t LaneFaces::CellsOfPlane(const SweepLane& lane) const
{
  return Count(lane.planes.sizeU) * lane.planes.sizeV;
}

void LaneFaces::EnterStart(const LaneBatch& batch, const Rays& rays, std::size_t first, const Buffer<float>& maps) const
{
  cl::Kernel kernel = this->Kernel("enter_start");
  for (int i = batch.first; i < batch.first + batch.count; ++i)
  {
    const SweepLane& lane = this->The.lanes[i];
    With(kernel, cl_int(i), rays.lanes, this->Faces, this->RayPlaces, rays.bundles, *this->FaceIn, cl_ulong(first),
      cl_ulong(this->Cells), maps);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(Count(lane.rays) * this->The.channels * this->CellsOfPlane(lane)));
  }
}

void LaneFaces::EnterSides(const LaneBatch& batch, const Rays& rays, std::size_t first)
{
  if (rays.ofRound)
  {
    this->SidesIn.Fill(0.0f);
    return;
  }
  cl::Kernel kernel = this->Kernel("enter_sides");
  for (int i = batch.first; i < batch.first + batch.count; ++i)
  {
    const SweepLane& lane = this->The.lanes[i];
    With(kernel, cl_int(i), rays.lanes, this->Faces, this->RayPlaces, rays.bundles, rays.crossings, rays.entering,
      this->FaceIn ? *this->FaceIn : this->SidesOut, cl_ulong(first), cl_ulong(this->Cells), this->SidesIn);
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange,
      cl::NDRange(
        SideFloats(lane), Count(lane.rays) * this->The.channels, static_cast<std::size_t>(lane.patternPlanes)));
  }
}

void LaneFaces::Leave(
  const LaneBatch& batch, const Rays& rays, std::size_t first, const std::array<const Buffer<float>*, 2>& maps) const
{
  if (!this->FaceOut)
  {
    return;
  }
  cl::Kernel sides = this->Kernel("leave_sides"), end = this->Kernel("leave_end");
  for (int i = batch.first; i < batch.first + batch.count; ++i)
  {
    this->LeaveSides(sides, i, rays, first);
    if (!batch.around)
    {
      this->LeaveEnd(end, i, rays, first, *maps[this->The.lanes[i].patternPlanes % 2]);
    }
  }
}

void LaneFaces::LeaveSides(cl::Kernel& kernel, int number, const Rays& rays, std::size_t first) const
{
  const SweepLane& lane = this->The.lanes[number];
  With(kernel, cl_int(number), rays.lanes, this->Faces, this->RayPlaces, rays.bundles, rays.crossings,
    cl_int(rays.ofRound), this->SidesIn, this->SidesOut, *this->FaceOut, cl_ulong(first), cl_ulong(this->Cells));
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange,
    cl::NDRange(Count(std::max(lane.planes.sizeU, lane.planes.sizeV)), Count(lane.planes.sizeP),
      std::size_t{ 4 } * this->The.channels));
}

void LaneFaces::LeaveEnd(
  cl::Kernel& kernel, int number, const Rays& rays, std::size_t first, const Buffer<float>& maps) const
{
  With(kernel, cl_int(number), rays.lanes, this->Faces, maps, *this->FaceOut, cl_ulong(first), cl_ulong(this->Cells));
  this->TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(this->CellsOfPlane(this->The.lanes[number]), Count(this->The.channels)));
}
}
