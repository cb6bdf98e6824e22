# SPDX-License-Identifier: Apache-2.0
"""The surface that tests of ranks fit: a scene for `burnish measure --surface`, and options of the fit."""

SCENE = {"version": 1, "materials": ["ggx:alpha_x=0.2,alpha_y=0.2,f0=0.6,kd=0.1", "ggx:alpha_x=0.5,alpha_y=0.5"],
         "shares": {"cells": 4, "seed": 3}, "heights": {"cells": 6, "seed": 5, "amplitude": 0.01},
         "lights": {"count": 20, "angle_deg": 60}, "views": {"count": 2, "angle_deg": 40}, "noise": 0.02,
         "held_out": 10}
OPTIONS = ["--lobes", "2", "--lobe-bytes", "2048", "--rounds", "2", "--threads", "1"]
