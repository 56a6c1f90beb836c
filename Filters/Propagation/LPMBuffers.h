#pragma once

/// Names of arrays and field data that vtkLPMPropagate writes and vtkLPMCollect reads.
namespace tyndall
{
/// The arrays that hold T, by the face that light travels towards.
constexpr const char* const NamesOfT[6] = { "T_xmin", "T_xmax", "T_ymin", "T_ymax", "T_zmin", "T_zmax" };

/// Field data: settings of the propagation.
constexpr const char* const MapResolutionFact = "map_resolution";
constexpr const char* const StoredDirectionsFact = "stored_directions_count";
constexpr const char* const OrderFact = "scattering_order";
}
