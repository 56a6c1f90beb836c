#ifndef RepresentationHints_h
#define RepresentationHints_h

/// Initialises new representations according to hints of the source that they show:
///
/// - <DirectColors port="P"/>: output P (without `port`, every output) is shown in its own colours, without a colour
///   bar. ParaView would map bytes of red, green and blue through a colour map.
/// - <ColoredBy port="P" array="NAME"/>: output P is coloured by cell array NAME if the array exists, regardless of the
///   colours of the input. If the array's colour map is new and the array's largest value is at least a hundred times
///   its smallest, the map is logarithmic. A representation that opens as Lit Volume, which uses no colour map, is
///   coloured when its type is first changed.
/// - <Plotted port="P" x="NAME" y="NAME NAME ..."/>: a line chart of table P initially plots these columns, instead of
///   all columns over the row number. Its left axis is logarithmic if nothing else is in the view. With y_begin="TEXT"
///   columns whose names begin with TEXT are plotted as well; with style="points" rows are points without lines, and
///   both axes are logarithmic.
/// - <VolumeColors .../>: shows the output as a volume in its own colours; see VolumeColors.h.
///
/// Installs the observers that apply these hints to new representations. To be called when the plugin is loaded; works
/// in windows and in scripts.
void FollowRepresentationHints();

#endif
