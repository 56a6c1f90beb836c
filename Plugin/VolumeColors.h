#ifndef VolumeColors_h
#define VolumeColors_h

class vtkSMProxy;

/// Shows a volume in its own colours. Follows a representation of an output whose proxy has the hint
///
///   <VolumeColors port="P" array="NAME" distance="FACT"/>
///
/// Cell array NAME has red, green, blue and alpha of voxels, as bytes; field data FACT is the unit distance, over which
/// alpha is the opacity. If the array exists, the output opens as ParaView's Volume in these colours: Map Scalars off,
/// an opacity function that rises from 0 to 1 over the values 0 to 255 and is not rescaled, and the unit distance of
/// the field data. These settings are also made when Volume is chosen later. If another array is chosen, Map Scalars is
/// switched on again.
///
/// Applies the hint <VolumeColors> to a representation, and follows its changes. To be called when the representation
/// is registered.
void FollowVolumeColors(vtkSMProxy* representation);

#endif
