#include "ParallelPropagation.h"

#include "TyndallKernelSources.h"

#include <algorithm>
#include <string>

namespace tyndall
{
namespace
{
/// Voxel crossings between two reports; about 50 ms on two cores.
constexpr double CrossingsPerReport = 3e7;

// The structs below are the kernels' own, declared there as map_info, crossing_info, volume_info and part_info.
struct Map
{
  cl_int sizeU, sizeV, rowStride, volume, rayRow, periodicU, periodicV, periodicW, directions;
};

struct CrossingOnDevice
{
  cl_int direction, parity, moveU, moveV, source;
  cl_float length;
};

struct Volumes
{
  cl_int size[3];
  cl_int row[2], plane[2], volume[2];

  Volumes(const Grid& grid, int width)
    : size{ grid.size[0], grid.size[1], grid.size[2] }
  {
    const int across[2][3] = { { this->size[0], this->size[1], this->size[2] },
      { this->size[1], this->size[2], this->size[0] } };
    for (int layout = 0; layout < 2; ++layout)
    {
      this->row[layout] = (across[layout][0] + width - 1) / width * width;
      const cl_int rows = this->row[layout] * across[layout][1];
      this->plane[layout] = (rows + 15) / 16 * 16 + (rows % 1024 == 0 ? 16 : 0); // not a multiple of 4 KB
      this->volume[layout] = this->plane[layout] * across[layout][2];
    }
  }

  std::size_t Index(int layout, int x, int y, int z) const
  {
    return layout == 0 ? static_cast<std::size_t>(z) * this->plane[0] + y * this->row[0] + x
                       : static_cast<std::size_t>(x) * this->plane[1] + z * this->row[1] + y;
  }
};

struct PartOnDevice
{
  cl_int moment;
  cl_float factor;
  cl_int layout, slot;
};

/// One launch: some of the crossings in one plane.
struct Launch
{
  int plane, first, count;
  bool add;
};

/// A batch's way through the volume on one of the N x N sub-maps ("divide the LPM into N smaller sub-LPM", section 5).
struct Pass
{
  std::vector<Launch> launches;
  int end = 0; ///< its crossings for EndRays
  std::size_t carriedFirst = 0;
};

struct Batch
{
  int first = 0, count = 0; ///< directions
  cl_int firstCoefficient = 0;
  std::size_t carriedFirst = 0;
  std::vector<MapGeometry> maps;
  std::vector<Pass> passes;
  Buffer<CrossingOnDevice> crossings; ///< of all passes
  int Layout() const { return this->maps[0].axis == 0 ? 1 : 0; }
};

int RoundUp(int value, int step)
{
  return (value + step - 1) / step * step;
}
}

struct ParallelPropagation::Implementation
{
  Implementation(Device& device, const Medium& medium, const Illumination& illumination,
    const PropagationSettings& settings, std::size_t temporaryBytes, int channels)
    : TheDevice(device)
    , TheMedium(medium)
    , Settings(settings)
    , Model(medium, illumination, settings, channels)
    , Ledger(medium, this->Model, settings)
    , Channels(this->Model.Channels())
    , Width(device.IsCpu() ? (device.FloatVectorWidth() >= 16 ? 16 : 8) : 1)
    , Volume(medium.grid, this->Width)
    , Coloured(medium.sigma_a.components == 3 || medium.sigma_s.components == 3)
    , Emits(medium.emission.values != nullptr)
    , LeftOut(LeftOutAsPublished(illumination))
  {
    this->CheckSize();
    this->MakeMedium();
    this->MakeSources();
    this->MakeMoments();
    this->MakeBatches(temporaryBytes);
    this->MakeKernels();
  }

  // --- Set-up ---

  void CheckSize() const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const double padded = static_cast<double>(RoundUp(this->Volume.size[axis], this->Width));
      const double voxels = padded * (this->Volume.size[(axis + 1) % 3] + 17.0) * this->Volume.size[(axis + 2) % 3];
      if (voxels > 2147483647.0)
      {
        throw DeviceError("The grid is too large for " + this->TheDevice.Name() +
          ": the published algorithm addresses 2^31 voxels. Use a coarser grid.");
      }
    }
  }

  /// A quantity in one layout, channel by channel, the padding zero.
  template <class Value>
  std::vector<float> Arrange(int layout, int channels, Value value) const
  {
    std::vector<float> arranged(static_cast<std::size_t>(this->Volume.volume[layout]) * channels, 0.0f);
    this->ForEach(layout, channels, [&](std::size_t at, std::size_t voxel, int c) { arranged[at] = value(voxel, c); });
    return arranged;
  }

  /// visit(index in the layout, voxel x fastest, channel)
  template <class Visit>
  void ForEach(int layout, int channels, Visit visit) const
  {
    for (int c = 0; c < channels; ++c)
    {
      std::size_t voxel = 0;
      for (int z = 0; z < this->Volume.size[2]; ++z)
      {
        for (int y = 0; y < this->Volume.size[1]; ++y)
        {
          for (int x = 0; x < this->Volume.size[0]; ++x, ++voxel)
          {
            visit(static_cast<std::size_t>(c) * this->Volume.volume[layout] + this->Volume.Index(layout, x, y, z),
              voxel, c);
          }
        }
      }
    }
  }

  void MakeMedium()
  {
    const int channels = this->Coloured ? 3 : 1;
    for (int layout = 0; layout < 2; ++layout)
    {
      const auto scattering = [&](std::size_t voxel, int c) { return this->TheMedium.sigma_s.At(voxel, c); };
      const auto extinction = [&](std::size_t voxel, int c) {
        return this->TheMedium.sigma_a.At(voxel, c) + this->TheMedium.sigma_s.At(voxel, c);
      };
      this->Extinction[layout] =
        Buffer<float>(this->TheDevice, this->Arrange(layout, channels, extinction), "the extinction coefficient");
      this->Scattering[layout] =
        Buffer<float>(this->TheDevice, this->Arrange(layout, channels, scattering), "the scattering coefficient");
    }
  }

  /// U in the layouts in which the maps read it: -1 where none does.
  void MakeSources()
  {
    const DirectionSet& set = this->Model.Directions();
    const int sources = static_cast<int>(this->Model.SourceDirections().size());
    std::vector<PartOnDevice> parts;
    for (int layout = 0; layout < 2; ++layout)
    {
      this->SourceSlot[layout].assign(sources, -1);
      int slots = 0;
      for (std::size_t i = 0; i < set.directions.size(); ++i)
      {
        const bool alongX = static_cast<int>(i) / set.PerFace() / 2 == 0;
        int& slot = this->SourceSlot[layout][this->Model.SourceOf(static_cast<int>(i))];
        slot = (layout == 1) == alongX && slot < 0 ? slots++ : slot;
      }
      for (int d = 0; d < sources; ++d)
      {
        if (this->SourceSlot[layout][d] >= 0)
        {
          const PublishedModel::Part part = this->Model.Source(d);
          parts.push_back({ part.moment, static_cast<float>(part.factor), layout, this->SourceSlot[layout][d] });
        }
      }
      const std::size_t size = static_cast<std::size_t>(this->Volume.volume[layout]) * this->Channels;
      this->Sources[layout] = Buffer<float>(this->TheDevice, size * slots, "the unscattered radiance U");
      this->Sources[layout].Fill(0.0f);
    }
    this->Parts = Buffer<PartOnDevice>(this->TheDevice, parts, "the list of U");
    if (this->Emits)
    {
      this->WriteSource([&](std::size_t voxel, int, int c) { return this->TheMedium.emission.At(voxel, c); });
    }
  }

  template <class Value>
  void WriteSource(Value value)
  {
    for (int layout = 0; layout < 2; ++layout)
    {
      std::vector<float> all;
      for (std::size_t slot = 0; slot * this->LayoutSize(layout) < this->Sources[layout].Size(); ++slot)
      {
        const auto found =
          std::find(this->SourceSlot[layout].begin(), this->SourceSlot[layout].end(), static_cast<int>(slot));
        const int d = static_cast<int>(found - this->SourceSlot[layout].begin());
        const std::vector<float> one =
          this->Arrange(layout, this->Channels, [&](std::size_t voxel, int c) { return value(voxel, d, c); });
        all.insert(all.end(), one.begin(), one.end());
      }
      this->Sources[layout].Write(all.data());
    }
  }

  std::size_t LayoutSize(int layout) const
  {
    return static_cast<std::size_t>(this->Volume.volume[layout]) * this->Channels;
  }

  void MakeMoments()
  {
    for (int layout = 0; layout < 2; ++layout)
    {
      this->OrderMoments[layout] =
        Buffer<float>(this->TheDevice, this->LayoutSize(layout) * this->Model.MomentCount(), "the moments of an order");
      this->OrderMoments[layout].Fill(0.0f);
    }
    this->Totals = Buffer<float>(this->TheDevice, this->LayoutSize(0) * this->Model.MomentCount(), "the moments");
    this->Totals.Fill(0.0f);
  }

  void MakeBatches(std::size_t temporaryBytes)
  {
    const DirectionSet& set = this->Model.Directions();
    const int perFace = set.PerFace();
    const int perBatch = this->DirectionsPerBatch(temporaryBytes);
    for (int face = 0; face < 6; ++face)
    {
      for (int first = 0; first < perFace; first += perBatch)
      {
        Batch batch;
        batch.first = face * perFace + first;
        batch.count = std::min(perBatch, perFace - first);
        for (int i = 0; i < batch.count; ++i)
        {
          batch.maps.emplace_back(
            this->TheMedium.grid, this->Settings, set.directions[batch.first + i], batch.first + i, perFace);
        }
        this->Batches.push_back(std::move(batch));
      }
    }
    std::size_t carried = 0;
    std::size_t rays = 0;
    std::size_t escaped = 0;
    std::vector<float> coefficients;
    for (Batch& batch : this->Batches)
    {
      batch.carriedFirst = carried;
      carried += this->Settings.periodic[batch.maps[0].axis] ? this->MapFloats(batch) * batch.count : 0;
      this->MakePasses(batch, 0);
      const std::size_t slots = static_cast<std::size_t>(batch.count) * this->Channels;
      rays = std::max(rays, 2 * slots * (batch.maps[0].sizeV + 2) * this->RayRow(batch));
      escaped = std::max(escaped, slots * this->EscapedPerSlot(batch));
      this->AppendCoefficients(batch, coefficients);
    }
    this->Coefficients = Buffer<float>(this->TheDevice, coefficients, "the scattering factors");
    this->Rays = Buffer<float>(this->TheDevice, rays, "the light propagation maps");
    this->Rays.Fill(0.0f);
    this->Escaped = Buffer<float>(this->TheDevice, escaped, "the light that leaves");
    for (Buffer<float>& buffer : this->Carried)
    {
      buffer = Buffer<float>(this->TheDevice, carried, "the light on its way through a periodic axis");
      buffer.Fill(0.0f);
    }
    this->Contributions = Buffer<float>(
      this->TheDevice, perBatch * std::max(this->LayoutSize(0), this->LayoutSize(1)), "the temporary buffers T");
    this->Boundary =
      Buffer<float>(this->TheDevice, static_cast<std::size_t>(perFace) * 3 * this->Channels, "the boundary");
  }

  /// All of a face where they fit into what may be taken; at least one.
  int DirectionsPerBatch(std::size_t temporaryBytes) const
  {
    const int perFace = this->Model.Directions().PerFace();
    const std::size_t one = std::max(this->LayoutSize(0), this->LayoutSize(1)) * sizeof(float);
    const std::size_t map = static_cast<std::size_t>(
      4.0 * this->Channels * sizeof(float) * this->RayMapSize()); // two ray maps; as much again for tables
    const std::size_t taken = this->TheDevice.BytesInUse() + map * perFace;
    const std::size_t left = this->TheDevice.MemoryLimit() - std::min(taken, this->TheDevice.MemoryLimit());
    std::size_t most = std::min(left, this->TheDevice.AllocationLimit());
    most = temporaryBytes > 0 ? std::min(most, temporaryBytes) : most;
    return static_cast<int>(std::clamp<std::size_t>(most / one, 1, perFace));
  }

  double RayMapSize() const
  {
    double largest = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double u = this->Volume.size[axis == 0 ? 1 : 0];
      const double v = this->Volume.size[axis == 2 ? 1 : 2];
      largest = std::max(largest, (u + 3.0 * this->Width) * (v + 2.0));
    }
    return largest;
  }

  int RayRow(const Batch& batch) const { return RoundUp(batch.maps[0].sizeU, this->Width) + 2 * this->Width; }
  int EscapedPerSlot(const Batch& batch) const { return 2 * batch.maps[0].sizeV + 1; }

  /// Floats of one direction's map, all sub-maps and channels.
  std::size_t MapFloats(const Batch& batch) const
  {
    return static_cast<std::size_t>(batch.maps[0].sizeU) * batch.maps[0].sizeV * this->Channels *
      this->Settings.mapResolution * this->Settings.mapResolution;
  }

  /// Works out where the rays of the batch go: for all sub-maps and planes the crossings of all directions, launch by launch.
  void MakePasses(Batch& batch, int order)
  {
    const int subMaps = this->Settings.mapResolution * this->Settings.mapResolution;
    std::vector<CrossingOnDevice> crossings;
    batch.passes.clear();
    for (int subMap = 0; subMap < subMaps; ++subMap)
    {
      std::vector<std::vector<std::vector<CrossingOnDevice>>> byPlane(batch.maps[0].planes); // [plane][voxel in it]
      std::vector<CrossingOnDevice> ends;
      for (int i = 0; i < batch.count; ++i)
      {
        this->WalkThrough(batch, i, subMap, order, byPlane, ends);
      }
      Pass pass;
      for (int plane = 0; plane < batch.maps[0].planes; ++plane)
      {
        for (std::size_t voxel = 0; voxel < byPlane[plane].size(); ++voxel)
        {
          const std::vector<CrossingOnDevice>& together = byPlane[plane][voxel];
          pass.launches.push_back({ batch.maps[0].forward ? plane : batch.maps[0].planes - 1 - plane,
            static_cast<int>(crossings.size()), static_cast<int>(together.size()), subMap > 0 || voxel > 0 });
          crossings.insert(crossings.end(), together.begin(), together.end());
        }
      }
      pass.end = static_cast<int>(crossings.size());
      crossings.insert(crossings.end(), ends.begin(), ends.end());
      pass.carriedFirst = batch.carriedFirst + subMap * (this->MapFloats(batch) / subMaps);
      batch.passes.push_back(std::move(pass));
    }
    batch.crossings = Buffer<CrossingOnDevice>(this->TheDevice, crossings, "the table of voxel crossings");
  }

  GridWalk Walk(const MapGeometry& map, int subMap, int order) const
  {
    const int resolution = this->Settings.mapResolution;
    return { map.StartOfOrder((subMap % resolution + 0.5) / resolution, map.slopeU, order),
      map.StartOfOrder((subMap / resolution + 0.5) / resolution, map.slopeV, order), map.slopeU, map.slopeV,
      map.planes };
  }

  void WalkThrough(const Batch& batch, int i, int subMap, int order,
    std::vector<std::vector<std::vector<CrossingOnDevice>>>& byPlane, std::vector<CrossingOnDevice>& ends) const
  {
    const int source = this->SourceSlot[batch.Layout()][this->Model.SourceOf(batch.first + i)];
    GridWalk walk = this->Walk(batch.maps[i], subMap, order);
    int parity = 0;
    int plane = -1;
    std::size_t voxel = 0;
    while (walk.Next())
    {
      voxel = walk.plane == plane ? voxel + 1 : 0;
      plane = walk.plane;
      byPlane[plane].resize(std::max(byPlane[plane].size(), voxel + 1));
      byPlane[plane][voxel].push_back(
        { i, parity, walk.moveU, walk.moveV, source, static_cast<float>(walk.fraction * batch.maps[i].length) });
      parity = 1 - parity;
    }
    ends.push_back({ i, parity, 0, 0, 0, 0.0f });
  }

  void AppendCoefficients(Batch& batch, std::vector<float>& coefficients)
  {
    batch.firstCoefficient = static_cast<cl_int>(coefficients.size());
    for (int k = 0; k < this->Model.MomentCount(); ++k)
    {
      for (int i = 0; i < batch.count; ++i)
      {
        coefficients.push_back(static_cast<float>(this->Model.Coefficient(k, batch.first + i) * batch.maps[i].density));
      }
    }
  }

  void MakeKernels()
  {
    const std::string common = "-DREAL_WIDTH=" + std::to_string(this->Width) +
      " -DCHANNELS=" + std::to_string(this->Channels) + " -DCOLOURED=" + (this->Coloured ? "1" : "0");
    const auto propagate = [&](const char* name, int source) {
      return this->TheDevice.Kernel(name, { kernel_source::Numerics, kernel_source::PublishedPropagate },
        common + " -DSOURCE=" + std::to_string(source));
    };
    const auto collect = [&](const char* name) {
      return this->TheDevice.Kernel(name, { kernel_source::Numerics, kernel_source::PublishedCollect },
        common + " -DMOMENTS=" + std::to_string(this->Model.MomentCount()));
    };
    this->StartRays = propagate("StartRays", 1);
    this->CrossVoxels[0] = propagate("CrossVoxels", 0);
    this->CrossVoxels[1] = propagate("CrossVoxels", 1);
    this->EndRays = propagate("EndRays", 1);
    this->AddDirections = collect("AddDirections");
    this->UpdateSources = collect("UpdateSources");
  }

  // --- One order ---

  bool FirstOrder() const { return this->Ledger.Orders() == 0 && !this->SourceGiven; }

  void Propagate(int number, const Monitor& monitor)
  {
    Batch& batch = this->Batches[number];
    const MapGeometry& map = batch.maps[0];
    const int slots = batch.count * this->Channels;
    const Map info = { map.sizeU, map.sizeV,
      map.axis == 0     ? this->Volume.row[1]
        : map.axis == 1 ? this->Volume.plane[0]
                        : this->Volume.row[0],
      this->Volume.volume[batch.Layout()], this->RayRow(batch), this->Settings.periodic[map.axisU],
      this->Settings.periodic[map.axisV], this->Settings.periodic[map.axis], batch.count };
    const cl_ulong carriedStride = this->MapFloats(batch);
    if (this->Ledger.Orders() > 0 && this->Settings.periodic[map.axis])
    {
      this->MakePasses(batch, this->Ledger.Orders()); // rays go on from where they were
    }
    this->WriteBoundary(batch);
    for (std::size_t p = 0; p < batch.passes.size(); ++p)
    {
      const Pass& pass = batch.passes[p];
      this->Escaped.Fill(0.0f);
      this->Enqueue(With(this->StartRays, info, this->Rays, this->Boundary, this->Carried[0],
                      static_cast<cl_ulong>(pass.carriedFirst), carriedStride),
        { map.sizeU + 2, map.sizeV + 2, slots }, { 32, 8, 1 });
      double done = (number + p / static_cast<double>(batch.passes.size())) / this->Batches.size();
      this->CrossPlanes(batch, pass, info, monitor, done);
      this->Enqueue(With(this->EndRays, info, static_cast<cl_int>(pass.end), batch.crossings, this->Rays, this->Escaped,
                      this->Carried[1], static_cast<cl_ulong>(pass.carriedFirst), carriedStride),
        { map.sizeV, slots, 1 }, { 16, 1, 1 });
      this->TallyEscaped(batch);
    }
    Report(monitor, this->Ledger.Progress((number + 1.0) / this->Batches.size()));
  }

  void CrossPlanes(const Batch& batch, const Pass& pass, const Map& info, const Monitor& monitor, double done)
  {
    const MapGeometry& map = batch.maps[0];
    const int planeStride = map.axis == 0 ? this->Volume.plane[1]
      : map.axis == 1                     ? this->Volume.row[0]
                                          : this->Volume.plane[0];
    const int layout = batch.Layout();
    cl::Kernel& kernel = this->CrossVoxels[this->FirstOrder() && !this->Emits ? 0 : 1];
    With(kernel, info, cl_int(0), cl_int(0), cl_int(0), batch.crossings, this->Extinction[layout],
      this->Scattering[layout], this->Sources[layout], this->Rays, this->Contributions, this->Escaped);
    const bool rows = this->Width > 1; // a work-item a row, else a voxel
    double sinceReport = 0.0;
    for (std::size_t l = 0; l < pass.launches.size(); ++l)
    {
      const Launch& launch = pass.launches[l];
      kernel.setArg(1, launch.plane * planeStride);
      kernel.setArg(2, static_cast<cl_int>(launch.add));
      kernel.setArg(3, static_cast<cl_int>(launch.first));
      const int slots = launch.count * this->Channels;
      rows ? this->Enqueue(kernel, { 1, map.sizeV, slots }, { 1, 16, 1 })
           : this->Enqueue(kernel, { map.sizeU, map.sizeV, slots }, { 32, 8, 1 });
      sinceReport += static_cast<double>(map.sizeU) * map.sizeV * slots;
      if (sinceReport > CrossingsPerReport)
      {
        sinceReport = 0.0;
        this->TheDevice.Finish();
        Report(monitor,
          this->Ledger.Progress(
            done + (l + 1.0) / (pass.launches.size() * batch.passes.size() * this->Batches.size())));
      }
    }
  }

  void Enqueue(cl::Kernel& kernel, std::array<int, 3> global, std::array<int, 3> local)
  {
    const auto size = [&](int d) { return static_cast<std::size_t>(RoundUp(global[d], local[d])); };
    this->TheDevice.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(size(0), size(1), size(2)), cl::NDRange(local[0], local[1], local[2]));
  }

  void WriteBoundary(const Batch& batch)
  {
    std::vector<float> boundary(this->Boundary.Size(), 0.0f);
    std::size_t at = 0;
    for (int i = 0; i < batch.count && this->FirstOrder(); ++i)
    {
      for (int axis : { batch.maps[i].axis, batch.maps[i].axisU, batch.maps[i].axisV })
      {
        for (int c = 0; c < this->Channels; ++c)
        {
          boundary[at++] = static_cast<float>(this->Model.Boundary(batch.first + i, axis)[c]);
        }
      }
    }
    this->Boundary.Write(boundary.data());
    if (this->FirstOrder())
    {
      this->TallyEntered(batch);
    }
  }

  /// Rays that start on the map, and those that come in anew through a side.
  void TallyEntered(const Batch& batch)
  {
    const int subMaps = this->Settings.mapResolution * this->Settings.mapResolution;
    for (int i = 0; i < batch.count; ++i)
    {
      const MapGeometry& map = batch.maps[i];
      const auto enter = [&](int axis, double rays) {
        const Rgb& boundary = this->Model.Boundary(batch.first + i, axis);
        for (int c = 0; c < this->Channels; ++c)
        {
          this->Ledger.entered[c] += rays * map.beamPower * boundary[c];
        }
      };
      enter(map.axis, static_cast<double>(map.sizeU) * map.sizeV * subMaps);
      for (int subMap = 0; subMap < subMaps; ++subMap)
      {
        GridWalk walk = this->Walk(map, subMap, 0);
        while (walk.Next())
        {
          const bool entersU = walk.moveU != 0 && !this->Settings.periodic[map.axisU];
          const bool entersV = walk.moveV != 0 && !this->Settings.periodic[map.axisV];
          const double edge = entersU && entersV ? 0.5 : 0.0; // one ray enters half through either side
          enter(map.axisU, entersU ? map.sizeV - edge : 0.0);
          enter(map.axisV, entersV ? map.sizeU - edge : 0.0);
        }
      }
    }
  }

  /// Reads what a pass left at the borders; waits for the device.
  void TallyEscaped(const Batch& batch)
  {
    const std::vector<float> escaped = this->Escaped.Read();
    const int rows = batch.maps[0].sizeV;
    std::size_t at = 0;
    for (int i = 0; i < batch.count; ++i)
    {
      const MapGeometry& map = batch.maps[i];
      const auto take = [&](int count, double& power) {
        double sum = 0.0;
        for (int k = 0; k < count; ++k)
        {
          sum += escaped[at++];
        }
        power += map.beamPower * sum;
      };
      for (int c = 0; c < this->Channels; ++c)
      {
        take(rows, this->Ledger.facePowerOut[map.ExitFace(map.axisU)][c]);
        take(1, this->Ledger.facePowerOut[map.ExitFace(map.axisV)][c]);
        take(rows,
          this->Settings.periodic[map.axis] ? this->Ledger.carried[c]
                                            : this->Ledger.facePowerOut[map.ExitFace(map.axis)][c]);
      }
    }
  }

  void Collect(int number)
  {
    const Batch& batch = this->Batches[number];
    const int layout = batch.Layout();
    const bool begins = number == 0 || this->Batches[number - 1].Layout() != layout;
    const cl_int volume = this->Volume.volume[layout];
    this->Enqueue(With(this->AddDirections, volume, static_cast<cl_int>(batch.count), static_cast<cl_int>(!begins),
                    batch.firstCoefficient, this->Coefficients, this->Contributions, this->OrderMoments[layout]),
      { volume / this->Width, this->Channels, 1 }, { 64, 1, 1 });
    this->TheDevice.Finish();
  }

  void FinishOrder()
  {
    this->Enqueue(
      With(this->UpdateSources, this->Volume, static_cast<cl_int>(this->Parts.Size()), this->Parts, this->Scattering[0],
        this->OrderMoments[0], this->OrderMoments[1], this->Totals, this->Sources[0], this->Sources[1]),
      { this->Volume.size[0], this->Volume.size[1], this->Volume.size[2] * this->Channels }, { 32, 8, 1 });
    const std::vector<float> fluence = this->ReadMoment(this->OrderMoments[0], 0);
    if (this->Ledger.Orders() == 0)
    {
      this->FluenceDirect = fluence;
    }
    this->Ledger.CloseOrder(fluence.data());
    this->Ledger.carried = {};
    std::swap(this->Carried[0], this->Carried[1]);
    this->Emits = true; // from now on U is not zero
  }

  // --- Results ---

  /// From a layout to x fastest with channels interleaved.
  std::vector<float> Interleave(int layout, const float* arranged) const
  {
    std::vector<float> values(this->TheMedium.grid.VoxelCount() * this->Channels);
    this->ForEach(layout, this->Channels,
      [&](std::size_t at, std::size_t voxel, int c) { values[voxel * this->Channels + c] = arranged[at]; });
    return values;
  }

  std::vector<float> ReadMoment(const Buffer<float>& moments, int moment) const
  {
    return this->Interleave(0, this->ReadPart(moments, moment * this->LayoutSize(0), this->LayoutSize(0)).data());
  }

  std::vector<float> ReadPart(const Buffer<float>& buffer, std::size_t first, std::size_t count) const
  {
    std::vector<float> part(count);
    this->TheDevice.Queue().enqueueReadBuffer(
      buffer.Handle(), CL_TRUE, first * sizeof(float), count * sizeof(float), part.data());
    return part;
  }

  LightField Result() const
  {
    LightField field;
    const std::size_t voxels = this->TheMedium.grid.VoxelCount();
    const std::size_t channels = static_cast<std::size_t>(this->Channels);
    field.channels = this->Channels;
    field.fluence = this->ReadMoment(this->Totals, 0);
    field.fluenceDirect = this->FluenceDirect;
    field.storedDirections = this->Model.StoredDirections();
    const std::size_t stored = field.storedDirections.size();
    field.scatteredRadiance.resize(voxels * channels * stored);
    for (std::size_t d = 0; d < stored; ++d)
    {
      const PublishedModel::Part part = this->Model.ScatteredRadiance(static_cast<int>(d));
      const std::vector<float> moment = this->ReadMoment(this->Totals, part.moment);
      for (std::size_t i = 0; i < moment.size(); ++i)
      {
        field.scatteredRadiance[(i / channels * stored + d) * channels + i % channels] =
          static_cast<float>(part.factor) * moment[i];
      }
    }
    for (int axis = 0; axis < 3 && this->Settings.netFlux; ++axis)
    {
      field.netFlux.resize(3 * voxels * channels);
      const std::vector<float> flux = this->ReadMoment(this->Totals, this->Model.NetFlux(axis));
      for (std::size_t i = 0; i < flux.size(); ++i)
      {
        field.netFlux[3 * i + axis] = flux[i];
      }
    }
    this->Ledger.WriteTo(field);
    field.leftOut = this->LeftOut;
    field.device = this->TheDevice.Name();
    return field;
  }

  std::vector<float> ReadSource() const
  {
    const std::size_t sources = this->Model.SourceDirections().size();
    const std::size_t channels = static_cast<std::size_t>(this->Channels);
    std::vector<float> all(this->TheMedium.grid.VoxelCount() * channels * sources);
    for (std::size_t d = 0; d < sources; ++d)
    {
      const int layout = this->SourceSlot[0][d] >= 0 ? 0 : 1;
      const int slot = this->SourceSlot[layout][d];
      if (slot >= 0)
      {
        const std::vector<float> one = this->Interleave(layout,
          this->ReadPart(this->Sources[layout], slot * this->LayoutSize(layout), this->LayoutSize(layout)).data());
        for (std::size_t i = 0; i < one.size(); ++i)
        {
          all[(i / channels * sources + d) * channels + i % channels] = one[i];
        }
      }
    }
    return all;
  }

  Device& TheDevice;
  const Medium& TheMedium;
  PropagationSettings Settings;
  PublishedModel Model;
  OrderLedger Ledger;
  int Channels;
  int Width; ///< floats a work-item handles at once
  Volumes Volume;
  bool Coloured; ///< sigma has all channels
  bool Emits;    ///< U is not zero
  bool SourceGiven = false;
  std::vector<std::string> LeftOut;
  std::vector<Batch> Batches;
  std::vector<int> SourceSlot[2]; ///< by layout: where the U of a direction is, or -1
  std::vector<float> FluenceDirect;

  Buffer<float> Extinction[2], Scattering[2], Sources[2], OrderMoments[2]; ///< by layout, [...][channel][volume]
  Buffer<float> Totals;                                                    ///< moments of all orders, layout 0
  Buffer<PartOnDevice> Parts;
  Buffer<float> Coefficients, Rays, Escaped, Contributions, Boundary;
  Buffer<float> Carried[2]; ///< of the order before, of this one
  cl::Kernel StartRays, CrossVoxels[2], EndRays, AddDirections, UpdateSources;
};

ParallelPropagation::ParallelPropagation(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, std::size_t temporaryBytes, int channels)
  : Inner(std::make_unique<Implementation>(device, medium, illumination, settings, temporaryBytes, channels))
{
}

ParallelPropagation::~ParallelPropagation() = default;

const PublishedModel& ParallelPropagation::Model() const
{
  return this->Inner->Model;
}

int ParallelPropagation::BatchCount() const
{
  return static_cast<int>(this->Inner->Batches.size());
}

int ParallelPropagation::FirstDirection(int batch) const
{
  return batch < this->BatchCount() ? this->Inner->Batches[batch].first
                                    : static_cast<int>(this->Model().Directions().directions.size());
}

void ParallelPropagation::Propagate(int batch, const Monitor& monitor)
{
  this->Inner->Propagate(batch, monitor);
}

void ParallelPropagation::Collect(int batch)
{
  this->Inner->Collect(batch);
}

void ParallelPropagation::FinishOrder()
{
  this->Inner->FinishOrder();
}

void ParallelPropagation::RunOrder(const Monitor& monitor)
{
  for (int batch = 0; batch < this->BatchCount(); ++batch)
  {
    this->Propagate(batch, monitor);
    this->Collect(batch);
  }
  this->FinishOrder();
}

bool ParallelPropagation::Done() const
{
  return this->Inner->Ledger.Done();
}

std::vector<std::vector<float>> ParallelPropagation::Contributions(int batch) const
{
  const Batch& which = this->Inner->Batches[batch];
  const std::size_t size = this->Inner->LayoutSize(which.Layout());
  std::vector<std::vector<float>> contributions;
  for (int i = 0; i < which.count; ++i)
  {
    contributions.push_back(this->Inner->Interleave(
      which.Layout(), this->Inner->ReadPart(this->Inner->Contributions, i * size, size).data()));
  }
  return contributions;
}

void ParallelPropagation::SetContributions(int batch, const std::vector<std::vector<float>>& contributions)
{
  const Batch& which = this->Inner->Batches[batch];
  const std::size_t channels = static_cast<std::size_t>(this->Inner->Channels);
  for (int i = 0; i < which.count; ++i)
  {
    const std::vector<float> arranged = this->Inner->Arrange(which.Layout(), this->Inner->Channels,
      [&](std::size_t voxel, int c) { return contributions[i][voxel * channels + c]; });
    this->Inner->TheDevice.Queue().enqueueWriteBuffer(this->Inner->Contributions.Handle(), CL_TRUE,
      i * arranged.size() * sizeof(float), arranged.size() * sizeof(float), arranged.data());
  }
}

std::vector<float> ParallelPropagation::Source() const
{
  return this->Inner->ReadSource();
}

void ParallelPropagation::SetSource(const std::vector<float>& source)
{
  const std::size_t channels = static_cast<std::size_t>(this->Inner->Channels);
  const std::size_t sources = this->Model().SourceDirections().size();
  this->Inner->WriteSource(
    [&](std::size_t voxel, int d, int c) { return source[(voxel * sources + d) * channels + c]; });
  this->Inner->SourceGiven = true;
  this->Inner->Emits = true;
}

LightField ParallelPropagation::Result() const
{
  return this->Inner->Result();
}

LightField SolveParallel(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor, std::size_t temporaryBytes)
{
  ParallelPropagation propagation(device, medium, illumination, settings, temporaryBytes);
  do
  {
    propagation.RunOrder(monitor);
  } while (!propagation.Done());
  return propagation.Result();
}
}
