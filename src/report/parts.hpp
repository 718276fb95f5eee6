#pragma once
// What every page is made of: the files of this folder and two libraries, as they were when the program was built.
#include <string_view>

namespace elamin::parts {

extern const std::string_view page_html, style_css, data_js, diagram_js, shape_js, charts_js, page_js, licences_txt;
extern const std::string_view three_js, orbit_js, d3_js;   // https://threejs.org, its OrbitControls, https://d3js.org

}  // namespace elamin::parts
