// Printed by odds_calibration (tests/calibration), which names the meshes that it was fitted on; do not edit by hand.
#pragma once

#include <array>

#include "query/answer_odds.hpp"

namespace odds::query {

/// By odds_index.
inline constexpr std::array<AnswerOdds, 8> answer_odds = {{
    // binary trees, cells, exact and incremental
    {{1.1446F, -0.3234F, 0.1943F, 1.0540F, -1.1348F, -0.7347F, 0.2442F, -0.1741F, -0.9955F, 0.9981F},
     {0.2468F, 0.2468F, 0.2468F, 0.3068F, 0.3925F, 0.5032F, 0.6190F, 0.6595F, 0.6595F, 0.6595F, 0.6595F}},
    // binary trees, cells, time-critical
    {{1.9737F, -0.6277F, 0.4541F, 0.9844F, -0.9620F, -1.3189F, 0.3611F, -0.1845F, -1.2475F, 1.2996F},
     {0.0626F, 0.0650F, 0.1807F, 0.3036F, 0.4226F, 0.4946F, 0.5402F, 0.7327F, 0.8153F, 0.8153F, 0.8153F}},
    // binary trees, kinematic, exact and incremental
    {{1.0926F, -0.2915F, 0.1885F, 0.3369F, -0.3876F, -0.8957F, 0.2177F, -0.1978F, 1.5611F, -1.5658F},
     {0.2742F, 0.2742F, 0.2742F, 0.2805F, 0.4031F, 0.4767F, 0.6790F, 0.7790F, 0.7861F, 0.7861F, 0.7861F}},
    // binary trees, kinematic, time-critical
    {{1.6486F, -0.6374F, 0.5823F, 0.0741F, 0.1576F, -0.0081F, 0.3542F, -0.4448F, -0.6597F, 0.4494F},
     {0.0355F, 0.0677F, 0.2080F, 0.3188F, 0.3921F, 0.4950F, 0.6244F, 0.7112F, 0.7313F, 0.7313F, 0.7313F}},
    // wide engine, cells, exact and incremental
    {{1.6215F, -0.4917F, 0.5856F, 0.0593F, 0.1553F, -1.0273F, 0.3942F, -0.5824F, -0.0989F, 0.3629F},
     {0.1124F, 0.1141F, 0.2078F, 0.3394F, 0.3978F, 0.4763F, 0.5584F, 0.7242F, 0.8926F, 0.9480F, 0.9480F}},
    // wide engine, cells, time-critical
    {{2.3146F, -0.7789F, 0.8168F, 0.0333F, 0.1037F, -2.2721F, 0.5415F, -0.6001F, -0.0866F, 0.5436F},
     {0.0492F, 0.1037F, 0.2130F, 0.3215F, 0.3981F, 0.4805F, 0.5457F, 0.7507F, 0.8892F, 0.8971F, 0.8971F}},
    // wide engine, kinematic, exact and incremental
    {{0.7181F, -0.4309F, 0.7175F, 0.1290F, 0.1420F, 0.0805F, 0.3274F, -0.7769F, -0.2019F, 0.3700F},
     {0.1017F, 0.1153F, 0.2078F, 0.3339F, 0.3923F, 0.4718F, 0.5873F, 0.6773F, 0.9047F, 0.9856F, 0.9856F}},
    // wide engine, kinematic, time-critical
    {{1.3075F, -0.6103F, 0.7642F, 0.0926F, 0.1404F, -1.4532F, 0.5703F, -0.7894F, -0.1391F, 0.6800F},
     {0.0865F, 0.1032F, 0.2441F, 0.3141F, 0.3952F, 0.4674F, 0.5466F, 0.7354F, 0.9437F, 0.9562F, 0.9562F}},
}};

}  // namespace odds::query
