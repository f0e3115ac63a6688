#include "models/textures/textures.h"

#include <array>

namespace groundloop::textures {

std::span<const Texture> all_textures() {
  static const std::array<Texture, 54> kTextures = {{
      {"floor_tiles", floor_tiles, 1},
      {"ceiling_tiles", ceiling_tiles, 2},
      {"plain_plaster", plain_plaster, 3},
      {"painted_blocks", painted_blocks, 4},
      {"light_wood", light_wood, 5},
      {"dark_wood", dark_wood, 6},
      {"grey_laminate", grey_laminate, 7},
      {"brushed_metal", brushed_metal, 8},
      {"carpet", carpet, 9},
      {"fabric", fabric, 10},
      {"cardboard_1", cardboard, 11},
      {"cardboard_2", cardboard, 12},
      {"painted_metal", painted_metal, 13},
      {"paper_poster_1", paper_poster, 21},
      {"paper_poster_2", paper_poster, 22},
      {"paper_poster_3", paper_poster, 23},
      {"paper_poster_4", paper_poster, 24},
      {"photo_poster_1", photo_poster, 25},
      {"photo_poster_2", photo_poster, 26},
      {"photo_poster_3", photo_poster, 27},
      {"table_poster", table_poster, 28},
      {"map_poster", map_poster, 29},
      {"book_row_1", book_row, 31},
      {"book_row_2", book_row, 32},
      {"book_row_3", book_row, 33},
      {"book_row_4", book_row, 34},
      {"binder_row_1", binder_row, 35},
      {"binder_row_2", binder_row, 36},
      {"whiteboard", whiteboard, 37},
      {"cork_board", cork_board, 38},
      {"code_screen_1", code_screen, 39},
      {"code_screen_2", code_screen, 40},
      {"plot_screen_1", plot_screen, 41},
      {"plot_screen_2", plot_screen, 42},
      {"window_view", window_view, 43},
      {"papers_1", papers, 44},
      {"papers_2", papers, 45},
      {"rack_panels_1", rack_panels, 51},
      {"rack_panels_2", rack_panels, 52},
      {"rack_panels_3", rack_panels, 53},
      {"oscilloscope_1", oscilloscope, 54},
      {"oscilloscope_2", oscilloscope, 55},
      {"power_supply_1", power_supply, 56},
      {"power_supply_2", power_supply, 57},
      {"keyboard", keyboard, 58},
      {"cabinet_doors_1", cabinet_doors, 59},
      {"cabinet_doors_2", cabinet_doors, 60},
      {"drawers_1", drawers, 61},
      {"drawers_2", drawers, 62},
      {"circuit_board", circuit_board, 63},
      {"door_1", door, 64},
      {"door_2", door, 65},
      {"breadboard_plate", breadboard_plate, 66},
      {"switchboard", switchboard, 67},
  }};
  return kTextures;
}

}  // namespace groundloop::textures
