#include "DiscreteOrdinates/SweptOrders.h"

#include "DiscreteOrdinates/PipelinedSweep.h"
#include "DiscreteOrdinates/UpwindSweep.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Conservative/OrderSweeps.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int MostOrders = 10000;
/// Largest ratio of successive scattering orders with which later orders are extrapolated as a geometric series; this
/// limit bounds the sum of the series.
constexpr double FastestSeries = 0.99;

PairSums SumsOf(const OrdinatesSettings& settings)
{
  return settings.scattering == OrdinatesScattering::Matrix ? PairSums::Matrix : PairSums::Terms;
}

/// Whether a scattering source can be negative. It cannot if it is computed as a sum of products (PairSums::Terms) and
/// scattering is isotropic, so that the sum has one term.
bool CanBeNegative(const OrdinatesAngles& angles, const OrdinatesSettings& settings)
{
  return SumsOf(settings) == PairSums::Matrix || angles.phase.Terms() > 1;
}

std::unique_ptr<OrdinateSweep> SweepOf(Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles,
  const OrdinatesSettings& settings, const LightOfCells* reflecting)
{
  const SweptFaces faces = SweptFaces::Of(scene.domain.Whole(), settings.periodic, reflecting);
  const Grid& grid = scene.medium.grid;
  if (scene.domain.IsSerial())
  {
    return std::make_unique<UpwindSweep>(device, grid, angles.groups, faces);
  }
  return std::make_unique<PipelinedSweep>(device, scene.domain, grid, angles.groups, faces);
}

class SweptOrders
{
public:
  SweptOrders(
    Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles, const OrdinatesSettings& settings)
    : TheDevice(device)
    , Scene(scene)
    , Settings(settings)
    , Arrays(device, scene, angles, settings.netFlux)
    , Cells(CellsOf(this->Arrays.Faces.get()))
    , Sweep(SweepOf(device, scene, angles, settings, this->Cells ? &*this->Cells : nullptr))
    , Scattering(device, angles.groups, angles.phase, SumsOf(settings), CanBeNegative(angles, settings),
        settings.netFlux, this->Arrays.Voxels, settings.leaveOut)
    , Radiance(device, AngularScattering::Floats(angles.groups, this->Arrays.Voxels), "radiance of all directions")
    , Source(device, this->Scattering.WorksInPlace() ? 0 : this->Radiance.Size(), "scattered light of all directions")
  {
  }

  OrdinatesResult Run(const Monitor& monitor)
  {
    this->Arrays.TakeVacuumApart(AsPropagation(this->Settings));
    this->Arrays.LookAtAllRanks();
    this->FirstOrder(OfPart(monitor, 0.0, 0.1));
    this->OmitsSlabs = this->MayOmitEmptySlabs();
    const double empty = this->Settings.leaveOut ? this->Arrays.PartWithoutScattering() : 0.0;
    if (this->Arrays.Scatters() && empty > 0.0)
    {
      this->Result.leftOut.push_back(left_out::EmptyVoxels(empty));
    }
    this->Scene.domain.Collective([&] { this->FindEmptyBlocks(empty); });
    while (!this->Done())
    {
      const double residual = std::clamp(this->Record.Residual(), this->Settings.tolerance, 1.0);
      const double done = this->Settings.maximumOrders > 0
        ? static_cast<double>(this->Record.All().size()) / this->Settings.maximumOrders
        : std::log(residual) / std::log(std::min(this->Settings.tolerance, 0.5));
      this->Scene.domain.Collective([&] { Report(monitor, std::clamp(0.1 + 0.9 * done, 0.1, 0.99)); });
      this->Order(
        monitor ? Monitor([&](double) { return monitor(std::clamp(0.1 + 0.9 * done, 0.1, 0.99)); }) : Monitor());
    }
    this->SweepEmptySlabs(monitor);
    this->Scene.domain.Collective([&] { this->Finish(); });
    return std::move(this->Result);
  }

private:
  /// Whether orders after the first are swept only in the bounding box of the medium. The light that leaves this box is
  /// then carried on in one final sweep.
  bool MayOmitEmptySlabs() const
  {
    return this->Scene.domain.IsSerial() && this->Scattering.WorksInPlace() && this->Arrays.Scatters() &&
      !this->Arrays.Faces && this->Settings.seriesAfter == 0 &&
      PaysToOmitEmptySlabs(this->Scene.filled, this->Scene.medium.grid, AsPropagation(this->Settings));
  }

  /// Finds the blocks of voxels for which sweeps after the first store only sums over directions.
  /// @param part  fraction of the voxels that do not scatter
  void FindEmptyBlocks(double part)
  {
    const Grid& grid = this->Scene.medium.grid;
    if (this->TheDevice.IsCpu() && this->Arrays.Scatters() && part > 0.0) // on a GPU, work-items have one direction
    {
      this->Empty = Buffer<cl_uchar>(this->TheDevice,
        this->Arrays.EmptyBlocks(this->OmitsSlabs ? this->Scene.filled : VoxelBox{ { 0, 0, 0 }, grid.size }),
        "empty voxels");
    }
  }
  const Buffer<cl_uchar>* EmptyBlocks() const { return this->Empty.Size() > 0 ? &this->Empty : nullptr; }

  /// Final sweep: computes the light of all orders after the first in the empty voxels around the medium, and its
  /// escaped power by face.
  void SweepEmptySlabs(const Monitor& monitor)
  {
    if (!this->OmitsSlabs || this->Record.All().size() < 2)
    {
      return;
    }
    auto& sweep = static_cast<UpwindSweep&>(*this->Sweep); // the domain is serial
    const FacePowers powers = sweep.ApplyBeyond(this->Scene.filled, this->Swept(nullptr), monitor);
    this->Scattering.Gather(this->Radiance, this->Arrays.Light, monitor);
    for (int face = 0; face < 6; ++face)
    {
      this->Result.ledger.AssignFace(0, face, powers.out[face]);
    }
    this->Result.leftOut.push_back(left_out::EmptySlabs(this->Scene.filled, this->Scene.medium.grid));
  }

  const Buffer<float>& Out() const { return this->Source.Size() > 0 ? this->Source : this->Radiance; }

  /// Computes uncollided light and its first-collision source. Incident light and emission are swept; light of faces
  /// and lamps is computed along separate rays.
  void FirstOrder(const Monitor& monitor)
  {
    const bool swept = this->Scene.incoming || this->Scene.faces || this->Arrays.Emits() || !this->Settings.leaveOut;
    this->Scene.domain.Collective([&] { this->Radiance.Fill(0.0f); });
    if (this->Arrays.Emits())
    {
      this->Arrays.EmitEvenly(this->Radiance, this->Result.ledger);
    }
    if (swept)
    {
      this->SweepAndScatter(this->Scene.incoming, OfPart(monitor, 0.0, 0.5));
    }
    this->Scene.domain.Collective([&] {
      if (swept)
      {
        this->Result.direct = this->Arrays.Light.order.Read();
        return;
      }
      this->Source.Fill(0.0f);
      this->Result.direct.assign(this->Arrays.Voxels, 0.0f);
    });
    this->Arrays.AddLamps(this->Out(), this->Settings.periodic, this->Result, OfPart(monitor, 0.5, 1.0));
    std::vector<float> lamps;
    this->Scene.domain.Collective([&] { lamps = this->Arrays.Direct.Read(); });
    const ChannelArrays::Powers unscattered = this->Arrays.PowersOf(this->Result.direct, false);
    const ChannelArrays::Powers ofLamps = this->Arrays.PowersOf(lamps, true);
    this->Count(unscattered, ofLamps);
    for (std::size_t i = 0; i < lamps.size(); ++i)
    {
      this->Result.direct[i] += lamps[i];
    }
  }

  void Order(const Monitor& monitor)
  {
    this->SweepAndScatter({}, monitor);
    std::vector<float> found;
    this->Scene.domain.Collective([&] { found = this->Arrays.Light.order.Read(); });
    const ChannelArrays::Powers powers = this->Arrays.PowersOf(found, false);
    this->Count(powers, {});
  }

  void Finish()
  {
    this->Arrays.Read(this->Result);
    this->AddSeries();
    if (this->Arrays.Faces)
    {
      this->Result.facePower = this->Arrays.Faces->PerArea(this->Arrays.Faces->LeftInAll());
    }
    this->Result.convergence = std::move(this->Record.All());
  }

  bool GoesOnAsSeries() const
  {
    return this->Settings.seriesAfter > 0 && static_cast<int>(this->Record.All().size()) >= this->Settings.seriesAfter;
  }

  /// Extends the fluence by the orders that were not swept: they continue the last order as a geometric series, with
  /// the ratio of the last two orders.
  void AddSeries()
  {
    if (this->GoesOnAsSeries() && this->GoesOn > 0.0)
    {
      const double rate = std::clamp(this->Record.Rate(), 0.0, FastestSeries);
      const std::vector<float> last = this->Arrays.Light.order.Read();
      std::transform(last.begin(), last.end(), this->Result.fluence.begin(), this->Result.fluence.begin(),
        [&](float ofLast, float found) { return static_cast<float>(found + rate / (1.0 - rate) * ofLast); });
    }
  }

  OrdinateArrays Swept(const Buffer<cl_uchar>* empty) const
  {
    return { this->Radiance, this->Arrays.SigmaT, this->Arrays.Scale, nullptr, false, empty, this->Settings.netFlux };
  }

  /// @param within  whether only the box of the medium is swept
  FacePowers SweepOrder(const IncomingRadiance& incoming, bool within, const Monitor& monitor)
  {
    if (within)
    {
      auto& sweep = static_cast<UpwindSweep&>(*this->Sweep); // the domain is serial
      return sweep.ApplyWithin(this->Scene.filled, this->Swept(this->EmptyBlocks()), monitor);
    }
    const bool shines = !this->Record.All().empty() || this->Arrays.Emits() || !this->Settings.leaveOut;
    if (!shines && this->Scene.domain.IsSerial())
    {
      const double lit = static_cast<UpwindSweep&>(*this->Sweep).LitPart(incoming);
      if (lit < 1.0 && !this->Scene.faces)
      {
        this->Result.leftOut.push_back(left_out::DarkDirections(lit));
      }
    }
    return this->Sweep->Apply(this->Swept(this->EmptyBlocks()), incoming, shines, monitor);
  }

  void SweepAndScatter(const IncomingRadiance& incoming, const Monitor& monitor)
  {
    this->Radiance.Swap(this->Source.Size() > 0 && !this->Record.All().empty() ? this->Source : this->Radiance);
    const bool isFirst = this->Record.All().empty(), within = this->OmitsSlabs && !isFirst;
    const FacePowers powers = this->SweepOrder(incoming, within, monitor);
    if (isFirst)
    {
      this->Arrays.AddFaces(this->Radiance, this->Settings.periodic, this->Result.ledger, monitor);
    }
    for (int face = 0; face < 6; ++face)
    {
      this->Result.ledger.Enter(0, powers.in[face]);
      within ? this->Result.ledger.Escape(0, powers.out[face]) : this->Result.ledger.Escape(0, face, powers.out[face]);
    }
    this->WasOnTheWay = std::exchange(this->OnTheWay, powers.onTheWay);
    if (this->Arrays.Scatters() || !this->Settings.leaveOut)
    {
      this->Scene.domain.Collective([&] {
        this->Scattering.Scatter(this->Radiance, this->Arrays.SigmaS, this->Out(), this->Arrays.Scale,
          this->Arrays.Light, monitor, this->EmptyBlocks(), &this->Scene.medium.grid,
          within ? &this->Scene.filled : nullptr);
      });
      return;
    }
    this->Scene.domain.Collective([&] {
      this->Scattering.Gather(this->Radiance, this->Arrays.Light, monitor);
      // Without scattering, the source of the next sweep, which is stored in the array of the radiance, is 0. The next
      // sweep carries only light that wraps around periodic axes or was reflected; without such light there is no next
      // sweep.
      if (this->OnTheWay > 0.0 || this->Arrays.Faces)
      {
        this->Radiance.Fill(0.0f);
        this->Source.Fill(0.0f);
      }
    });
  }

  /// Reflects the outgoing light of this order (in the first order also that of lamps), and subtracts the reflected
  /// power from the escaped power.
  void Reflect()
  {
    if (!this->Arrays.Faces)
    {
      return;
    }
    std::array<Rgb, 6> back = {};
    this->Scene.domain.Collective([&] { back = this->Arrays.Faces->Reflect(); });
    this->Reflected = 0.0;
    for (int face = 0; face < 6; ++face)
    {
      this->Reflected += back[face][0];
      this->Result.ledger.Escape(0, face, -back[face][0]);
    }
  }

  void Count(const ChannelArrays::Powers& swept, const ChannelArrays::Powers& ofLamps)
  {
    this->Reflect();
    this->Result.ledger.Absorb(0, swept.absorbed + ofLamps.absorbed);
    const double others = swept.scattered + ofLamps.scattered + this->Reflected;
    this->GoesOn = GoesOnToItsEnd(this->Settings.maximumOrders, this->WasOnTheWay, this->OnTheWay, others);
    this->Result.ledger.SetUnaccounted(0, others + this->OnTheWay + this->Arrays.Stranded());
    this->Record.Add(this->GoesOn, this->Result.ledger);
  }

  bool Done() const
  {
    const int orders = static_cast<int>(this->Record.All().size());
    if (this->GoesOn == 0.0 || orders >= MostOrders || this->GoesOnAsSeries())
    {
      return true;
    }
    // Least number of orders: the sum of the later orders is estimated from the ratio of successive orders, which is
    // known after three.
    constexpr int least = 3;
    return this->Settings.maximumOrders > 0 ? orders >= this->Settings.maximumOrders
                                            : orders >= least && this->Record.Residual() <= this->Settings.tolerance;
  }

  Device& TheDevice;
  const OrdinatesScene& Scene;
  const OrdinatesSettings& Settings;
  ChannelArrays Arrays;
  const std::optional<LightOfCells> Cells;
  std::unique_ptr<OrdinateSweep> Sweep;
  AngularScattering Scattering;
  /// Radiance of all directions, and its scattering source; Source is empty if the source overwrites Radiance.
  Buffer<float> Radiance, Source;
  OrdinatesRecord Record;
  OrdinatesResult Result;
  bool OmitsSlabs = false; ///< MayOmitEmptySlabs()
  Buffer<cl_uchar> Empty;  ///< OrdinateArrays::empty of the orders after the first; no values: all voxels are stored
  /// Power that the next order carries, power that wraps around periodic axes in the next sweep, and reflected power,
  /// W.
  double GoesOn = 0.0, OnTheWay = 0.0, Reflected = 0.0;
  /// Power that wrapped around periodic axes between the last two sweeps, W.
  double WasOnTheWay = 0.0;
};
}

OrdinatesResult SolveSweptOrders(Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles,
  const OrdinatesSettings& settings, const Monitor& monitor)
{
  std::unique_ptr<SweptOrders> orders;
  scene.domain.Collective([&] { orders = std::make_unique<SweptOrders>(device, scene, angles, settings); });
  return orders->Run(monitor);
}

std::size_t BytesOfSweptOrders(const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings)
{
  const std::size_t voxels = grid.VoxelCount();
  const std::size_t radiance = AngularScattering::Floats(angles.groups, voxels) * sizeof(float);
  const PairSums sums = SumsOf(settings);
  return radiance * (sums == PairSums::Terms ? 1 : 2) + ChannelArrays::Bytes(grid, settings.netFlux) +
    AngularScattering::Bytes(angles.groups, angles.phase.Terms(), sums, voxels) +
    UpwindSweep::Bytes(grid, angles.groups);
}
}
