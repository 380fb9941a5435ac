#include "engine/lanes/random.hpp"
