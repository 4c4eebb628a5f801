// app/option_places.h - where a job's file gives the options that an error names.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <map>
#include <string>

namespace obscura::app {

/// Where options are given, such as "job.json#/options/hide", by their long names, by the files
/// that are their values, or by the names of outputs.
using OptionPlaces = std::map<std::string, std::string>;

/// An error of an option, a file or an output, with its place in the job in front.
Error at_its_place(Error error, const OptionPlaces& places);

}  // namespace obscura::app
