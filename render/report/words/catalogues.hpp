#pragma once

#include "render/report/words/messages.hpp"

#include <span>

namespace macadam {

// The words of the reports: words_en.cpp, words_de.cpp, and for the comparison with references
// words_reference_en.cpp, words_reference_de.cpp. Every language has the same keys with the same
// places; a test holds it.
std::span<const Message> english_messages();
std::span<const Message> english_reference_messages();
std::span<const Message> german_messages();
std::span<const Message> german_reference_messages();

} // namespace macadam
