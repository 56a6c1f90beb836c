#ifndef StartPreparation_h
#define StartPreparation_h

/// Starts TyndallPreparation, the program beside the plugin, which has OpenCL's kernels of the default chain compiled
/// while the user loads data. In ParaView's window and in pvserver's first process; scripts (pvpython, pvbatch) begin
/// with their own work at once. It runs behind all other work, ends with this process, and does nothing where all was
/// compiled before. TYNDALL_PREPARE=0 in the environment keeps it from starting.
///
/// A process of its own, not a thread: a compiler cannot be stopped halfway, and ParaView could not quit before it is
/// done.
///
/// To be called when the plugin is loaded.
void StartPreparation();

#endif
