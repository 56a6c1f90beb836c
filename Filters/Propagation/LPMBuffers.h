#pragma once

/// What vtkLPMPropagate and vtkLPMCollect have in common.
namespace tyndall
{
/// The arrays that hold T, by the face that light travels towards.
constexpr const char* const NamesOfT[6] = { "T_xmin", "T_xmax", "T_ymin", "T_ymax", "T_zmin", "T_zmax" };

/// Field data that goes with them.
constexpr const char* const MapResolutionFact = "map_resolution";
constexpr const char* const StoredDirectionsFact = "stored_directions_count";
constexpr const char* const OrderFact = "scattering_order";
}
