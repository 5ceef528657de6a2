/** @mainpage Vantage in C and C++
 *
 * Disparity maps and new views of stereo pairs in memory. Version 0: vantage_c.h is the interface
 * in C, for any language: functions, opaque handles, and structs of plain values. vantage.h is C++
 * for it, in the namespace vantage::v0. Link with -lvantage (pkg-config vantage;
 * find_package(vantage)). What follows holds for all functions.
 *
 * **Errors.** Functions that can fail return a vantage_status. The text of the last error of the
 * calling thread is vantage_last_error(): one line, what is wrong and what was expected. A function
 * that fails throws nothing, prints nothing, makes nothing, and leaves its outputs as they were.
 * Beside the errors that a function names, each can fail with #VANTAGE_USAGE for an address that is
 * NULL, and with #VANTAGE_NO_MEMORY.
 *
 * **Threads.** All functions may be called from any threads at once, also with the same handle; but
 * a handle must not be destroyed while another call uses it. A matcher works on threads of its own,
 * and divides them among calls. Calls return when their work is done.
 *
 * **Ownership.** What a function writes to a pointer to a handle belongs to the caller, who
 * destroys it. Pixels are the caller's, and are read or written during the call only. Texts that
 * are returned belong to the library; each function says how long they live. All are UTF-8 and end
 * with 0.
 *
 * **Pixels.** Column 0 is left, row 0 is above. Positions and disparities are in pixels of the
 * images that were given. Results are identical for any threads and processor.
 *
 * **Binary compatibility.** A program that was linked with libvantage.so.0 runs with later ones of
 * that name: functions stay, handles are opaque, and structs only grow at their end. Fields that
 * the library does not know must be 0.
 */
/** @file
 * The C interface. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What became of a call. */
typedef enum vantage_status {
  VANTAGE_OK = 0,       /**< It is done. */
  VANTAGE_ERROR = 1,    /**< These images cannot be processed. */
  VANTAGE_USAGE = 2,    /**< An argument or an option is invalid for any images. */
  VANTAGE_NO_MEMORY = 3 /**< There is not enough memory. */
} vantage_status;

/** One image of a pair. */
typedef enum vantage_side {
  VANTAGE_LEFT = 0, /**< The left one. */
  VANTAGE_RIGHT = 1 /**< The right one. */
} vantage_side;

/** Options and threads for many pairs, made by vantage_matcher_create(). It does not change. */
typedef struct vantage_matcher vantage_matcher;
/** Two images and what was found in them, made by vantage_match(). It does not change. */
typedef struct vantage_pair vantage_pair;

/** Pixels of an image in the caller's memory. The values of a pixel follow each other, and the
 * pixels of a row. Addresses need no alignment. */
typedef struct vantage_image {
  size_t struct_size;  /**< sizeof(vantage_image), as the caller knows it. */
  const void* pixels;  /**< The upper left pixel. */
  int32_t width_px;    /**< Columns, 1 to 65500. */
  int32_t height_px;   /**< Rows, 1 to 65500. */
  ptrdiff_t row_bytes; /**< To the next row, may be negative; 0: rows follow each other. */
  int32_t channels;    /**< 1: grey, 3: RGB, 4: RGB and alpha, which is not matched. */
  int32_t bits;        /**< 8 or 16: unsigned values; 32: float, NaN is no data, infinity an error;
                            white is 255, 65535 or 1, unless the brightest pixels or the option
                            "white-level" say otherwise. */
  int32_t is_bgr;      /**< 0: as above; 1: blue is first and red third. */
  int32_t reserved;    /**< Must be 0. */
} vantage_image;

/** Room for an image of the same layout, which a function fills in. */
typedef struct vantage_picture {
  size_t struct_size;  /**< sizeof(vantage_picture), as the caller knows it. */
  void* pixels;        /**< The upper left pixel; a multiple of the size of a value. */
  int32_t width_px;    /**< Columns. */
  int32_t height_px;   /**< Rows. */
  ptrdiff_t row_bytes; /**< As vantage_image::row_bytes, and a multiple of the size of a value. */
  int32_t channels;    /**< As vantage_image::channels. */
  int32_t bits;        /**< As vantage_image::bits. */
  int32_t is_bgr;      /**< As vantage_image::is_bgr. */
  int32_t reserved;    /**< Must be 0. */
} vantage_picture;

/** The version of the library that runs, such as "0.2.0". Never fails. The text lives for ever. */
const char* vantage_version(void);

/** The last error of the calling thread, "" before the first. It begins with the option or field
 * that is meant, where one is. Never fails. The text lives until the next failing call of this
 * thread. */
const char* vantage_last_error(void);

/** Makes a matcher, to be kept from pair to pair.
 *
 * `options` are `count` texts NAME=VALUE, with the names and values of the options of `vantage
 * match` and `vantage synth` without dashes: "preset=quality", "disparities=0:63", "threads=4",
 * "rows=as-is", "holes=texture". What is not given has the program's defaults: preset balanced,
 * disparities found for each pair, all processors. Where `count` is 0, `options` may be NULL. The
 * texts are copied.
 *
 * #VANTAGE_USAGE: an option is unknown, a value is wrong, or options cannot be combined. */
vantage_status vantage_matcher_create(const char* const* options, size_t count,
                                      vantage_matcher** matcher);
/** Destroys a matcher, or nothing where it is NULL. Its pairs live on. */
void vantage_matcher_destroy(vantage_matcher* matcher);

/** Matches a rectified pair of equal size, channels and bits: makes the disparity maps of both
 * images.
 *
 * Objects are farther left in `right` than in `left`. The images are copied. Black borders and
 * pixels without data are left out. Rows that are off by up to a few pixels are corrected, unless
 * "rows=as-is"; vantage_pair_remark() tells.
 *
 * #VANTAGE_ERROR: the shapes differ, a size, number of channels or value is out of its range, or
 * the images do not show a range of disparities and none was given. #VANTAGE_USAGE: `bits` or a
 * field of a later version. */
vantage_status vantage_match(const vantage_matcher* matcher, const vantage_image* left,
                             const vantage_image* right, vantage_pair** pair);
/** Destroys a pair, or nothing where it is NULL. */
void vantage_pair_destroy(vantage_pair* pair);

/** Writes the disparity map of the image `side`: x_left - x_right in pixels, NaN where it is
 * unknown, within the range that was searched.
 *
 * `map` has the size of the image, 1 channel and 32 bits. #VANTAGE_USAGE: it has not, or `side` is
 * none. */
vantage_status vantage_pair_disparity(const vantage_pair* pair, vantage_side side,
                                      const vantage_picture* map);

/** Writes, for each pixel of the image `side`, the probability (0 to 1) that its disparity is
 * within 1 px of the true one; 0 where the disparity is unknown.
 *
 * The first call for a pair takes about as long as vantage_match(). `map` and errors are those of
 * vantage_pair_disparity(). */
vantage_status vantage_pair_confidence(const vantage_pair* pair, vantage_side side,
                                       const vantage_picture* map);

/** Writes the view of a camera at (x, y) in baselines, the distances of the cameras: (0, 0) is the
 * left camera, (1, 0) the right one, positive y is below. Both are from -16 to 16; between the
 * cameras views are best.
 *
 * `view` has the size, channels and bits of the images; `is_bgr` is its own. #VANTAGE_USAGE: it has
 * not, or the camera is farther away. */
vantage_status vantage_pair_view(const vantage_pair* pair, double x, double y,
                                 const vantage_picture* view);

/** What was found in the images, assumed or corrected: remark number `index`, counted from 0, one
 * line each; NULL beyond the last.
 *
 * `is_warning` is set to 1 where the maps may be wrong for it, to 0 for a note; it may be NULL.
 * Never fails. The text lives as long as the pair. */
const char* vantage_pair_remark(const vantage_pair* pair, size_t index, int* is_warning);

#ifdef __cplusplus
}
#endif
