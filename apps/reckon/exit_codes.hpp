// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace reckon::app {

/// The exit codes of reckon; docs/reference/command-line.md lists the same.
enum ExitCode : int {
  success = 0,         ///< done; diff: bit-identical; check: no faults
  input_at_fault = 1,  ///< usage, scene, or files; diff: the runs differ
  run_failed = 2,      ///< a run broke off; any command: no memory, or a disk that takes no more;
                       ///< diff: a run could not be read
  internal_error = 3,  ///< a fault of reckon itself
  interrupted = 130,   ///< Ctrl-C: a checkpoint was written (128 + SIGINT)
  terminated = 143,    ///< SIGTERM: a checkpoint was written (128 + SIGTERM)
};

inline constexpr const char* exit_code_footer =
    "Exit codes: 0 success, 1 the input is at fault, 2 the run failed or a disk or the memory is\n"
    "full, 3 a fault of reckon itself,\n"
    "130 or 143 stopped by Ctrl-C, or by SIGTERM and the like, after writing a checkpoint.";

}  // namespace reckon::app
