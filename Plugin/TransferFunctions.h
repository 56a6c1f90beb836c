#ifndef TransferFunctions_h
#define TransferFunctions_h

/// Fills in the transfer functions of filters whose proxy has the hint
///
///   <TransferFunctions flag="NAME" array="NAME"/>
///
/// When the property `flag` becomes 1 and LookupTable is empty, the filter's properties LookupTable,
/// ScalarOpacityFunction, ScalarOpacityUnitDistance and MapScalars, and the array, are set to those of a representation
/// of its input that is coloured by an array.
void FollowTransferFunctions();

#endif
