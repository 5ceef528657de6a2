/* C API of Vantage: disparity maps and new views of stereo pairs in memory. Version 0.
 *
 * Link with -lvantage (pkg-config vantage; find_package(vantage)). Bind it from any language: there
 * are functions, opaque handles, and structs of plain values.
 *
 * Errors. Functions that can fail return a vantage_status. The text of the last error of the
 * calling thread is vantage_last_error(): one line, what is wrong and what was expected. Nothing is
 * thrown, printed or made by a function that fails; its outputs are unchanged.
 *
 * Threads. All functions may be called from any threads at once, but a handle must not be destroyed
 * while another call uses it. A matcher works on threads of its own, and divides them among calls.
 *
 * Ownership. What a function writes to a pointer to a handle belongs to the caller, who destroys
 * it; destroying NULL does nothing. Pixels are the caller's, and are read or written during the
 * call only. Texts that are returned belong to the library; each function says how long they live.
 *
 * Binary compatibility. A program that was linked with libvantage.so.0 runs with later ones of that
 * name: functions stay, handles are opaque, and structs only grow at their end. `struct_size` is
 * sizeof the struct as the caller knows it. Fields that the library does not know must be 0.
 */
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum vantage_status {
  VANTAGE_OK = 0,
  VANTAGE_ERROR = 1, /* these images cannot be processed */
  VANTAGE_USAGE = 2, /* an argument or an option is invalid for any images */
  VANTAGE_NO_MEMORY = 3
} vantage_status;

typedef enum vantage_side { VANTAGE_LEFT = 0, VANTAGE_RIGHT = 1 } vantage_side;

/* Options and threads for many pairs. */
typedef struct vantage_matcher vantage_matcher;
/* Two images and what was found in them. */
typedef struct vantage_pair vantage_pair;

/* Pixels of an image in the caller's memory; values of a pixel follow each other, and pixels of a
 * row. */
typedef struct vantage_image {
  size_t struct_size;
  const void* pixels; /* of the upper left pixel */
  int32_t width_px;
  int32_t height_px;
  ptrdiff_t row_bytes; /* from a row to the next; may be negative; 0: rows follow each other */
  int32_t channels;    /* 1: grey, 3: RGB, 4: RGB and alpha */
  int32_t bits;        /* 8 or 16: unsigned, up to 255 or 65535; 32: float, 0 to 1, NaN: no data */
  int32_t is_bgr;      /* 1: blue comes first, and red third */
  int32_t reserved;    /* 0 */
} vantage_image;

/* Room for an image of the same layout, which a function fills in; addresses of values are
 * multiples of their size. */
typedef struct vantage_picture {
  size_t struct_size;
  void* pixels;
  int32_t width_px;
  int32_t height_px;
  ptrdiff_t row_bytes; /* as of vantage_image */
  int32_t channels;
  int32_t bits;
  int32_t is_bgr;
  int32_t reserved;
} vantage_picture;

/* "0.2.0", of the library that runs; lives for ever. */
const char* vantage_version(void);

/* The last error of the calling thread, "" before the first; lives until the next failing call of
 * this thread. Begins with the option or field that is meant, where one is. */
const char* vantage_last_error(void);

/* Makes a matcher. `options`: `count` texts NAME=VALUE, with the names and values of the options of
 * `vantage match` and `vantage synth` without dashes: "preset=quality", "disparities=0:63",
 * "threads=4", "rows=as-is", "holes=texture". What is not given has the program's defaults: preset
 * balanced, disparities found for each pair, all processors. `count` 0: `options` may be NULL.
 * VANTAGE_USAGE: an unknown option, a wrong value, or what cannot be combined. */
vantage_status vantage_matcher_create(const char* const* options, size_t count,
                                      vantage_matcher** matcher);
void vantage_matcher_destroy(vantage_matcher* matcher);

/* Matches a rectified pair of equal size, channels and bits: makes the maps of both images. The
 * images are copied. Black borders and pixels without data are left out; rows that are off by up to
 * a few pixels are corrected, unless "rows=as-is". Results are identical for any threads and
 * processor. The pair may outlive the matcher. */
vantage_status vantage_match(const vantage_matcher* matcher, const vantage_image* left,
                             const vantage_image* right, vantage_pair** pair);
void vantage_pair_destroy(vantage_pair* pair);

/* Writes the disparity map of an image: x_left - x_right in pixels, NaN where it is unknown, one
 * float for each pixel of the image as it was given. `map`: of the size of the image, 1 channel of
 * 32 bits. */
vantage_status vantage_pair_disparity(const vantage_pair* pair, vantage_side side,
                                      const vantage_picture* map);

/* Writes, of an image, the probability (0 to 1) that a disparity is within 1 px of the true one, 0
 * where it is unknown. `map` as for vantage_pair_disparity(). */
vantage_status vantage_pair_confidence(const vantage_pair* pair, vantage_side side,
                                       const vantage_picture* map);

/* Writes the view of a camera at (x, y) in baselines: 0 is the left camera, x = 1 the right one,
 * positive y is below. `view`: size, channels and bits of the images. VANTAGE_USAGE: the camera is
 * too far away. */
vantage_status vantage_pair_view(const vantage_pair* pair, double x, double y,
                                 const vantage_picture* view);

/* What was found in the images, assumed or corrected: number `index`, one line each, NULL beyond
 * the last; lives as long as the pair. `is_warning`: 1 where the maps may be wrong for it, 0 for a
 * note; may be NULL. */
const char* vantage_pair_remark(const vantage_pair* pair, size_t index, int* is_warning);

#ifdef __cplusplus
}
#endif
