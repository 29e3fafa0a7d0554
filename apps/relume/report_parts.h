// SPDX-License-Identifier: MIT
// What the pages of reports are put together from.
#pragma once
#include <string>

namespace relume::app {

struct ReportPicture {
  std::string file, caption;
  int width = 0, height = 0;
};

/// Everything up to and with <body>; `title` is not yet escaped.
std::string pageHead(const std::string& title);

/// A figure in the row of figures: the value in large, what it is below. `colour`: good, watch, bad or none.
std::string card(const std::string& value, const std::string& label, const std::string& colour = "");

/// An item of <ul class=notes>; `html` is taken as it is.
std::string note(const std::string& html, const std::string& colour);

/// <figure> of a picture that opens when clicked on; `kind`: wide, texels (drawn with sharp texels) or none.
std::string figure(const ReportPicture& picture, const std::string& caption, const char* kind = "");

/// Three digits, as people read them.
std::string shortNumber(double value);
/// "12.3 %", and "< 0.1 %" for little that is not nothing.
std::string percent(double share);

}  // namespace relume::app
