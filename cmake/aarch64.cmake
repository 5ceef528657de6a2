# Toolchain: Linux on aarch64, by Debian's cross compiler and the packages that
# scripts/lib/arm64_root.sh unpacks in build/arm64-root. Programs of the build run by qemu-user.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_OBJDUMP aarch64-linux-gnu-objdump)
set(VANTAGE_DEBIAN_ARCHITECTURE arm64)
get_filename_component(VANTAGE_ARM64_ROOT ${CMAKE_CURRENT_LIST_DIR}/../build/arm64-root ABSOLUTE)
set(CMAKE_SYSROOT ${VANTAGE_ARM64_ROOT})
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L ${VANTAGE_ARM64_ROOT})

# Programs of this machine, all else of the other one.
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{DPKG_ADMINDIR} ${VANTAGE_ARM64_ROOT}/var/lib/dpkg)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${VANTAGE_ARM64_ROOT})
set(ENV{PKG_CONFIG_LIBDIR}
  ${VANTAGE_ARM64_ROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${VANTAGE_ARM64_ROOT}/usr/share/pkgconfig)
