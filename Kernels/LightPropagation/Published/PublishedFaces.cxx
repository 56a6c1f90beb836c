#include "LightPropagation/Published/PublishedFaces.h"

#include "Medium/BoxFaces.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
namespace
{
/// W that radiance 1 brings in through each cell: adds up the rays of a map.
class CellPowers
{
public:
  CellPowers(const Grid& grid, const PropagationSettings& settings)
    : TheGrid(grid)
    , Settings(settings)
    , Powers(BoxFaceCellCount(grid), 0.0)
  {
  }

  void AddMap(const MapGeometry& map, int order)
  {
    this->AddAhead(map);
    for (int subMap = 0; subMap < this->Settings.mapResolution * this->Settings.mapResolution; ++subMap)
    {
      GridWalk walk = map.Walk(this->Settings.mapResolution, subMap, order);
      while (walk.Next())
      {
        const bool entersU = walk.moveU != 0 && !this->Settings.periodic[map.axisU];
        const bool entersV = walk.moveV != 0 && !this->Settings.periodic[map.axisV];
        const int plane = map.forward ? walk.plane : map.planes - 1 - walk.plane;
        const int edgeU = entersU ? (walk.moveU > 0 ? 0 : map.sizeU - 1) : -1;
        const int edgeV = entersV ? (walk.moveV > 0 ? 0 : map.sizeV - 1) : -1;
        if (entersU)
        {
          this->AddRow(map, map.axisU, plane, map.axisV, map.sizeV, edgeV);
        }
        if (entersV)
        {
          this->AddRow(map, map.axisV, plane, map.axisU, map.sizeU, edgeU);
        }
      }
    }
  }

  std::vector<double> Take() { return std::move(this->Powers); }

private:
  void AddAhead(const MapGeometry& map)
  {
    if (this->Settings.periodic[map.axis])
    {
      return;
    }
    const BoxFaceLayout layout = LayoutOfFace(this->TheGrid, map.EntryFace(map.axis));
    const double power = map.beamPower * this->Settings.mapResolution * this->Settings.mapResolution;
    const std::size_t cells = static_cast<std::size_t>(map.sizeU) * map.sizeV;
    for (std::size_t cell = 0; cell < cells; ++cell)
    {
      this->Powers[layout.first + cell] += power;
    }
  }

  /// Rays that come in aside through a plane's row of cells; half of one, at an edge, comes in through the other side.
  void AddRow(const MapGeometry& map, int entryAxis, int plane, int alongAxis, int size, int edge)
  {
    const BoxFaceLayout layout = LayoutOfFace(this->TheGrid, map.EntryFace(entryAxis));
    const std::size_t first = layout.first + plane * layout.step[map.axis];
    for (int i = 0; i < size; ++i)
    {
      this->Powers[first + i * layout.step[alongAxis]] += i == edge ? 0.5 * map.beamPower : map.beamPower;
    }
  }

  const Grid& TheGrid;
  const PropagationSettings& Settings;
  std::vector<double> Powers;
};
}

PublishedFaces::PublishedFaces(const Grid& grid, const PublishedModel& model, const PropagationSettings& settings)
  : TheGrid(grid)
  , Model(model)
  , Settings(settings)
{
  if (model.FacesReflect() || settings.facePower)
  {
    this->Reflection.emplace(grid, model.Channels(), this->PowerIn(0), model.FaceAlbedo());
    this->Out.assign(model.Channels() * this->Cells(), 0.0);
    this->All = this->Even = this->Out;
    this->Back.assign(this->Out.size(), 0.0f);
  }
}

std::size_t PublishedFaces::Cell(int face, const std::array<int, 3>& voxel) const
{
  const BoxFaceLayout layout = LayoutOfFace(this->TheGrid, face);
  return layout.first + voxel[0] * layout.step[0] + voxel[1] * layout.step[1] + voxel[2] * layout.step[2];
}

std::vector<double> PublishedFaces::PowerIn(int order) const
{
  const DirectionSet& set = this->Model.Directions();
  CellPowers powers(this->TheGrid, this->Settings);
  for (std::size_t i = 0; i < set.directions.size(); ++i)
  {
    const int index = static_cast<int>(i);
    powers.AddMap(MapGeometry(this->TheGrid, this->Settings, set.directions[i], index, set.PerFace()), order);
  }
  return powers.Take();
}

double PublishedFaces::Guessed(std::size_t i, int order) const
{
  return this->Guess.empty() || order > 1 ? 0.0 : order == 0 ? this->Guess[i] : -this->Guess[i];
}

void PublishedFaces::CloseOrder(OrderLedger& ledger)
{
  if (!this->Count())
  {
    return;
  }
  this->First = ledger.Orders() == 0 ? this->Out : this->First;
  std::vector<double> back(this->Out.size());
  for (std::size_t i = 0; i < back.size(); ++i)
  {
    back[i] = this->Reflection->AlbedoOf(i) * (this->Out[i] + this->Guessed(i, ledger.Orders()));
    this->All[i] += this->Out[i];
    this->Even[i] += this->Out[i] / this->Reflection->Pattern(i % this->Cells());
  }
  const std::array<bool, 3>& periodic = this->Settings.periodic;
  if (this->Reflection->Reflects() && std::find(periodic.begin(), periodic.end(), true) != periodic.end())
  {
    this->Reflection->SetPowerIn(this->PowerIn(ledger.Orders() + 1)); // rays go on from where they were
  }
  this->Back = this->Reflection->RadianceOf(back, std::vector<double>(back.size(), 0.0));
  ledger.GiveBack(this->Reflection->PowerOfFaces(back));
  std::fill(this->Out.begin(), this->Out.end(), 0.0);
}

std::vector<float> PublishedFaces::LeftLater() const
{
  std::vector<float> later(this->All.size());
  std::transform(this->All.begin(), this->All.end(), this->First.begin(), later.begin(),
    [](double all, double first) { return static_cast<float>(all - first); });
  return later;
}

void PublishedFaces::WriteTo(LightField& field) const
{
  field.faceAlbedo = this->Model.FaceAlbedo();
  if (this->Count())
  {
    field.facePower = this->Reflection->PerArea(this->Reflection->ScaledTo(this->Even, this->All));
  }
}
}
