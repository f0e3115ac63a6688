#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <string>

namespace groundloop::textures {

/// One image of models/generated: how it is called and how it is drawn.
struct Texture {
  const char* name;
  cv::Mat (*draw)(uint64_t key);
  uint64_t key;
};

/// Every texture that the worlds of models/worlds use.
std::span<const Texture> all_textures();

// surfaces.cpp: what things are made of. Tileable.
cv::Mat floor_tiles(uint64_t key);
cv::Mat ceiling_tiles(uint64_t key);
cv::Mat plain_plaster(uint64_t key);
cv::Mat painted_blocks(uint64_t key);
cv::Mat light_wood(uint64_t key);
cv::Mat dark_wood(uint64_t key);
cv::Mat grey_laminate(uint64_t key);
cv::Mat brushed_metal(uint64_t key);
cv::Mat carpet(uint64_t key);
cv::Mat fabric(uint64_t key);
cv::Mat cardboard(uint64_t key);
cv::Mat painted_metal(uint64_t key);

// prints.cpp: what is written, drawn and read.
cv::Mat paper_poster(uint64_t key);
cv::Mat photo_poster(uint64_t key);
cv::Mat table_poster(uint64_t key);
cv::Mat map_poster(uint64_t key);
cv::Mat book_row(uint64_t key);
cv::Mat binder_row(uint64_t key);
cv::Mat whiteboard(uint64_t key);
cv::Mat cork_board(uint64_t key);
cv::Mat code_screen(uint64_t key);
cv::Mat plot_screen(uint64_t key);
cv::Mat window_view(uint64_t key);
cv::Mat papers(uint64_t key);

// devices.cpp: what stands about in a laboratory.
cv::Mat rack_panels(uint64_t key);
cv::Mat oscilloscope(uint64_t key);
cv::Mat power_supply(uint64_t key);
cv::Mat keyboard(uint64_t key);
cv::Mat cabinet_doors(uint64_t key);
cv::Mat drawers(uint64_t key);
cv::Mat circuit_board(uint64_t key);
cv::Mat door(uint64_t key);
cv::Mat breadboard_plate(uint64_t key);
cv::Mat switchboard(uint64_t key);

}  // namespace groundloop::textures
