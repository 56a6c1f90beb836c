#ifndef ViewCameras_h
#define ViewCameras_h

/// Copies the camera of a 3D view to sources whose hints request it:
///
///     <ViewCamera button="NAME" follow="NAME" elsewhere="1">
///       <Property name="NAME" of="NAME" from="NAME"/>
///     </ViewCamera>
///
/// Each Property is set to the value of the view's property `of` (CameraPosition, ...), or, with `from`, to the vector
/// from the view's property `from` to `of`. This happens when the source's command `button` is called (its button on
/// the panel, or InvokeCommand in Python), and, while the source's property `follow` is not 0, whenever the view has
/// been rendered with another camera. The view is the active view or, if that has no camera, the first view with a
/// camera. With `elsewhere`, views that show the source itself are not considered. Views that show the source are
/// rendered again.
///
/// Installs the observers that apply the hint <ViewCamera>. To be called when the plugin is loaded; works in windows
/// and in scripts.
void FollowViewCameras();

#endif
