#pragma once

#include "render/report/words.hpp"

#include <span>

namespace macadam {

// The words of the reports: words_en.cpp, words_de.cpp. Every language has the same keys with the
// same places; a test holds it.
std::span<const Message> english_messages();
std::span<const Message> german_messages();

} // namespace macadam
