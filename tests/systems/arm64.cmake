# SPDX-License-Identifier: Apache-2.0
# CMake's toolchain for 64-bit ARM on a Debian with g++-aarch64-linux-gnu, libraries of the architecture arm64 and
# qemu-user.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64)
set(ENV{PKG_CONFIG_LIBDIR} /usr/lib/aarch64-linux-gnu/pkgconfig:/usr/share/pkgconfig)
set(CMAKE_CXX_FLAGS_INIT -Wno-psabi)  # notes on pairs of doubles, which GCC 10 began to pass otherwise
