#pragma once

// The library for its users. These headers and those that they include are installed; nothing else
// is (cmake/install_headers.cmake). Include this one, or those that are needed.

// Images, their input and output, and threads.
#include "engine/build_info.h"
#include "engine/error.h"
#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/image_region.h"
#include "engine/image/left_out.h"
#include "engine/image/memory_use.h"
#include "engine/image/photograph.h"
#include "engine/image/pixel_buffer.h"
#include "engine/image/white_level.h"
#include "engine/io/images/opencv_setup.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_formats.h"
#include "engine/io/maps/map_io.h"
#include "engine/io/maps/npy_volume_file.h"
#include "engine/io/video/frame_source.h"
#include "engine/io/video/video_io.h"

// Disparity maps of rectified pairs.
#include "engine/matching/options/match_options.h"
#include "engine/matching/options/match_presets.h"
#include "engine/matching/pair_matcher.h"
#include "engine/matching/range_estimation.h"
#include "engine/matching/search/match_report.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/matching/unrectified_matcher.h"
#include "engine/matching/volume/posterior_moments.h"

// Cameras, and unrectified pairs.
#include "engine/rectification/feature_matches.h"
#include "engine/rectification/improved_rectification.h"
#include "engine/rectification/rectification_file.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/rectification/rectifier.h"
#include "engine/rectification/rows/row_check.h"
#include "engine/rectification/rows/row_correction.h"
#include "engine/rectification/rows/row_remarks.h"
#include "engine/rectification/stereo_calibration.h"
#include "engine/rectification/uncalibrated_rig.h"
#include "engine/rectification/vertical_error.h"

// Depths, point clouds and surfaces of maps, and their files.
#include "engine/reprojection/map_camera.h"
#include "engine/reprojection/ply_file.h"
#include "engine/reprojection/point_cloud.h"
#include "engine/view_geometry/depth_resolution.h"

// New views of pairs; views and point clouds of scenes of many images.
#include "engine/scene_graph/posed_viewer.h"
#include "engine/scene_graph/scene_builder.h"
#include "engine/scene_graph/scene_cloud.h"
#include "engine/scene_graph/scene_viewer.h"
#include "engine/synthesis/synthesis_options.h"
#include "engine/synthesis/view_renderer.h"
#include "engine/synthesis/view_synthesizer.h"
#include "engine/view_geometry/new_view.h"
#include "engine/view_geometry/posed_camera.h"
#include "engine/view_geometry/view_pose.h"

// Sequences of pairs.
#include "engine/sequence/journal/run_journal.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/options/sequence_options.h"
#include "engine/sequence/pairs/pair_source.h"
#include "engine/sequence/sequence_runner.h"

// Accuracy of maps and views.
#include "engine/evaluation/disparity_evaluation.h"
#include "engine/evaluation/view_evaluation.h"
