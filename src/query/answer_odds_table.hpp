// Printed by odds_calibration (tests/calibration), which names the meshes that it was fitted on; do not edit by hand.
#pragma once

#include <array>

#include "query/answer_odds.hpp"

namespace odds::query {

/// By odds_index.
inline constexpr std::array<AnswerOdds, 8> answer_odds = {{
    // binary trees, cells, exact and incremental
    {{0.9602F, -0.2622F, 0.1755F, 0.6048F, -0.6670F, -0.7859F, 0.2084F, -0.1441F, -0.5778F, 0.5646F},
     {0.2954F, 0.2954F, 0.2954F, 0.3006F, 0.3951F, 0.4944F, 0.6063F, 0.6086F, 0.6086F, 0.6086F, 0.6086F}},
    // binary trees, cells, time-critical
    {{2.1050F, -0.6984F, 0.5106F, 1.0007F, -0.9808F, -1.5033F, 0.5000F, -0.3152F, -1.2616F, 1.3094F},
     {0.0561F, 0.0807F, 0.2142F, 0.2969F, 0.4154F, 0.4900F, 0.5864F, 0.7294F, 0.8167F, 0.8167F, 0.8167F}},
    // binary trees, kinematic, exact and incremental
    {{0.9269F, -0.2426F, 0.1600F, 0.2711F, -0.3156F, -1.0091F, 0.1931F, -0.1528F, 1.4472F, -1.4640F},
     {0.3023F, 0.3023F, 0.3023F, 0.3126F, 0.3958F, 0.4870F, 0.6435F, 0.7086F, 0.7086F, 0.7086F, 0.7086F}},
    // binary trees, kinematic, time-critical
    {{1.7876F, -0.6843F, 0.6225F, 0.0223F, 0.2320F, -0.2408F, 0.4569F, -0.5597F, -0.3396F, 0.0625F},
     {0.0465F, 0.0973F, 0.2066F, 0.2978F, 0.4001F, 0.4833F, 0.6267F, 0.7031F, 0.7492F, 0.7492F, 0.7492F}},
    // wide engine, cells, exact and incremental
    {{1.7534F, -0.4928F, 0.5420F, 0.0637F, 0.1675F, -1.4271F, 0.4263F, -0.5315F, -0.0997F, 0.3160F},
     {0.0836F, 0.0956F, 0.2165F, 0.3259F, 0.4102F, 0.4760F, 0.5515F, 0.7018F, 0.9117F, 0.9510F, 0.9510F}},
    // wide engine, cells, time-critical
    {{2.3851F, -0.7567F, 0.7442F, 0.0444F, 0.1787F, -2.0995F, 0.5873F, -0.6661F, -0.1194F, 0.6921F},
     {0.0482F, 0.1123F, 0.2167F, 0.3260F, 0.3917F, 0.4590F, 0.5702F, 0.7149F, 0.8807F, 0.8853F, 0.8853F}},
    // wide engine, kinematic, exact and incremental
    {{0.8544F, -0.4329F, 0.6697F, 0.1300F, 0.1522F, -0.3855F, 0.3631F, -0.7010F, -0.1812F, 0.3260F},
     {0.0659F, 0.0879F, 0.2375F, 0.3210F, 0.4096F, 0.4629F, 0.5491F, 0.7004F, 0.8874F, 0.9914F, 0.9914F}},
    // wide engine, kinematic, time-critical
    {{1.4373F, -0.6014F, 0.6950F, 0.1187F, 0.1816F, -1.4989F, 0.6053F, -0.8083F, -0.2009F, 0.7371F},
     {0.0374F, 0.0998F, 0.2247F, 0.3211F, 0.3864F, 0.4524F, 0.5617F, 0.7135F, 0.9464F, 0.9793F, 0.9805F}},
}};

}  // namespace odds::query
