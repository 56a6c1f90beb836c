#pragma once

/// Keeps this process to one core that no other test has, where there is one: its threads, of the device and of ranks,
/// then need not wake each other on other cores, which costs more than small grids do. They stay as many.
void KeepToOneCore();
