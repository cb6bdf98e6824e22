// SPDX-License-Identifier: Apache-2.0
#pragma once

// For the library's own files: JSON before it is text.

#include <initializer_list>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/expected_error.h>
#include <burnish/reflectance/node_figures.h>

namespace burnish {

/// An object of the figures that are asked for, by the names of members that are doubles, in that order; what is not
/// finite is null. Throws Error on other names.
nlohmann::ordered_json json_of(const ErrorFigures& figures,
                               std::initializer_list<std::string_view> names = {"psnr", "ssim", "relative",
                                                                                "rms_log", "log_cos"});

/// Likewise, after `count`.
nlohmann::ordered_json json_of(const NodeFigures& figures, std::initializer_list<std::string_view> names = {
                                                               "relative", "rms_log", "log_cos"});

/// `relative`, and `from_theta_i_deg`: an object of each band's figure by the angle that it begins at, in degrees.
nlohmann::ordered_json json_of(const ExpectedError& expected);

}  // namespace burnish
