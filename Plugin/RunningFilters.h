#ifndef RunningFilters_h
#define RunningFilters_h

/// Adds two abilities to the window of ParaView 5.11 while a filter runs, for proxies with the hint <StopsOnAbort/>:
///
/// - The abort button in the status bar works. ParaView has this button, but never enables it and ignores its signals.
///   Pressing it makes the filter's CheckAbort true; it has no effect on filters on a server. The status bar then says
///   that the filter was stopped, and Apply runs it again (StoppedFilters.h).
/// - The results on the panel (information_only) are those of the last run. Without this, ParaView reads them before
///   the run that Apply starts.
///
/// Installs these abilities for ParaView's window. To be called when the plugin is loaded. Without a window (pvpython,
/// pvbatch, pvserver) the function does nothing.
void FollowRunningFilters();

#endif
