// Every tolerance of the library: value, unit, reason, and the test that minds it.
#pragma once

namespace odds::tolerances {

/// Largest entry of R^T R - I that still counts as a rotation; no unit. Poses that a program accumulates in doubles
/// drift by about 1e-12 per million products; beyond 1e-6 a result would be wrong by more than a micrometre a metre.
/// Test: PairOfSpheres.RefusesAPoseThatIsNotRigid.
inline constexpr double pose_orthonormality = 1e-6;

/// An unproved probability keeps at least this distance from 0 and 1; no unit.
/// Test: PairOfSpheres.OnlyProofsAreCertain.
inline constexpr double least_uncertainty = 1e-9;

// Contact patches (src/query/patch/). Without a unit unless said otherwise.

/// A triangle whose area is less than this part of its longest side squared has no normal: rounding of 1e-16 a
/// coordinate would turn it by more than 1e-4. Test: ContactPatchHard.DegenerateTrianglesGiveFiniteContacts.
inline constexpr double degenerate_triangle = 1e-12;
/// Heights above a plane, and differences of points, below this part of the coordinates are rounding.
/// Test: ContactPatch.CoplanarTouchingFacesHaveDepthZero.
inline constexpr double on_plane = 1e-15;
/// Sine of the angle below which two triangles count as parallel and their common polygon replaces the line in which
/// their planes cross (which could be anywhere in it). Test: ContactPatch.CoplanarTouchingFacesHaveDepthZero.
inline constexpr double parallel_planes = 1e-9;
/// Ends of rim pieces nearer than this part of the rim's size are one point. Neighbouring triangles compute a common
/// end to some 1e-15. Test: ContactPatch.FourLegsGiveFourPatches.
inline constexpr double same_joint = 1e-9;
/// A rim whose vector area points against the normals along it by more than this part is the inner rim of a ring.
/// Test: ContactPatch.PipeStandsOnItsEnd.
inline constexpr double hole_rim = 0.2;
/// Curves of one direction whose boxes come nearer than this part of their diagonals are one patch.
inline constexpr double neighbour_share = 0.05;
/// Cosine of the angle (1.8 degrees) below which their directions are one. Test: ContactPatch.FlushBoxesMakeOnePatch.
inline constexpr double same_normal = 0.9995;
/// Curves whose lengths differ by less than this part are as long as each other.
/// Test: BedOnManySpikes.IsHeldByThoseAllAround.
inline constexpr double equal_curves = 0.1;
/// Seen along a direction, a triangle or a side at less than this sine is seen edge-on: its corners and crossings say
/// all. Test: ContactPatch.BoxOnBoxInManyRotations.
inline constexpr double edge_on = 1e-6;
/// Sine below which two sides seen along a direction are parallel and have no crossing of their own.
inline constexpr double parallel_sides = 1e-9;
/// A point outside a triangle by less than this part still is over it. Test: ContactPatch.BoxOnBoxInManyRotations.
inline constexpr double on_border = 1e-9;
/// Cosine of the angle (2 degrees) below which two face normals are gathered into one.
inline constexpr double same_face = 0.9994;
/// Sines of the angles from and to which a normal ceases to belong to a flat face (0.5 and 3 degrees).
inline constexpr double flat_from = 0.0087;
inline constexpr double flat_to = 0.0523;  ///< see flat_from
/// A lump of a whole rim between flush faces is no higher than by this factor than what lies beside it is deep, or is
/// believed to be: it is as much higher as the faces are tilted, by some per cent.
/// Test: FlushBricks.ThatLieInEachOtherPushUpwards.
inline constexpr double flush_lump = 1.5;
/// A whole rim has its own direction unless that of what lies beside it is a way out shorter by this factor: of a rod
/// through a plate both are as long. Test: ContactPatch.PreviousNormalBreaksTies.
inline constexpr double by_far_shorter = 0.5;
/// Share of the rim on one flat face from and to which the patch's normal becomes that face's.
/// Test: ContactPatch.BoxOverALedgeKeepsTheFaceNormal.
inline constexpr double snap_from = 0.7;
inline constexpr double snap_to = 0.95;  ///< see snap_from
/// A rim that bulges out of a body by less than this part of its size, in the mean, is on one face of it, to within the
/// rounding of corners in single precision; and one that does by more than that part is about an edge with no corner
/// beside it. Tests: ConcaveCorners.HoldByEachFace, ConcaveCorners.APillarOnAFloorIsOne.
inline constexpr double corner_bulge = 1e-7;
inline constexpr double edge_bulge = 0.1;  ///< see corner_bulge
/// Cosine (25 degrees) of the angle from which two normals may be of two faces of a corner, and up to which part of the
/// angle between two of these faces their own normals may spread: else the surface bends on all the way between them.
/// Tests: ConcaveCorners.HoldByEachFace, ConcaveCorners.AGutterIsNone.
inline constexpr double corner_bend = 0.906;
inline constexpr double corner_spread = 0.5;  ///< see corner_bend
/// Flat faces of one normal whose heights differ by more than this part of the rim's size are two, as treads of stairs
/// are. Test: ConcaveCorners.APillarOnAFloorIsOne.
inline constexpr double level_face = 1e-5;
/// By how much the way out of a face of a corner may be longer than that of all its faces: they were measured at other
/// places. Test: ConcaveCorners.HoldByEachFace.
inline constexpr double corner_deeper = 1.5;
/// Cosine (0.08 degrees) of the angle to which all normals along a rim are those of one flat face, in the mean, and how
/// far from its plane that may be left, as a part of the rim's size. Test: RoomsOfOneMesh.KeepCratesInTheirCorners.
inline constexpr double one_face = 1.0 - 1e-6;
inline constexpr double off_face = 2e-3;  ///< see one_face
/// Weight of the last normal against the bodies' places when the side of a sheet is chosen.
/// Test: ContactPatch.SheetPushesTowardsTheBody.
inline constexpr double previous_side = 0.3;
/// Weight of the side from which bodies came when they met against their places: a body stays on its side of a sheet
/// until the two are apart. Test: SheetInAHurry.
inline constexpr double came_side = 1.5;
/// Below this cosine against the side of the bodies a direction is on the wrong side of a sheet.
inline constexpr double weak_side = 0.1;
/// Bodies are pressed together by this part of a triangle's side before directions are compared: it decides only where
/// the overlap is smaller than that. Test: ContactPatch.EdgeTouchingAFaceHasTheFaceNormal.
inline constexpr double pressing_share = 1e-4;
/// Cosine (25 degrees) from which a direction counts as the last run's, and by how much it is preferred.
/// Test: ContactPatch.PreviousNormalBreaksTies.
inline constexpr double same_as_before = 0.9;
inline constexpr double hysteresis = 0.8;  ///< see same_as_before
/// By how much the vector area of a whole rim is preferred to a face's normal where it is small.
inline constexpr double area_preferred = 0.5;
/// A rim that ends where a sheet does tells no direction by its vector area, if its ends are farther apart than this
/// part of its length: the border came in from one side. Of a mesh with small holes they are near each other. Tests:
/// MisleadingRims.TheBorderOfASheetIsPushedOutSideways, MisleadingRims.AHoleInABodyTakesNoDirectionFromIt.
inline constexpr double gap_of_a_border = 0.5;
/// Vector area below this part of (coordinates x length of the rim) is rounding.
inline constexpr double rim_noise = 1e-12;
/// Rays that measure an overlap start this part of the coordinates inside of a rim: on it they may miss both bodies.
/// Test: FlushBricks.AreNotPushedSidewaysHoweverLittleTimeThereIs.
inline constexpr double within_both = 1e-9;
/// A ray that leaves a solid through a face at less than this sine runs along it, and rounding says which way.
/// Test: FlushBricks.ThatTouchWithinRoundingAreNotPushedFromEndToEnd.
inline constexpr double along_a_face = 1e-8;
/// Isoperimetric quotient from which a rim's vector area is its direction without a comparison; an open rim, of which
/// some is missing, must be rounder, and no rounder than a circle. Tests: ContactPatch.CrossedPlatesPartTheShortWay,
/// ContactPatch.FewHitsStillGiveTheNormal.
inline constexpr double round_closed_rim = 0.05;
inline constexpr double round_open_rim = 0.2;  ///< see round_closed_rim
/// Contacts are where the overlap has at least this part of the patch's depth: at the rim itself it has none.
/// Test: ContactPatch.TessellationDoesNotMoveTheContacts.
inline constexpr double shallow_share = 0.2;
/// Half-way to the deepest point, a flat overlap has the mean depth, a ball's a quarter of the depth more: from this
/// much on it is round, and bears at its deepest point only (contacts around it would brake a ball that rolls). Test:
/// ContactPatch.SphereOnPlaneHasOneDeepContact.
inline constexpr double round_overlap = 0.12;
/// Cosine below which two patches push against each other. Test: ContactPatch.CrossedPlatesPartTheShortWay.
inline constexpr double opposed = -0.3;
/// A patch whose depth is below this part of the rim's extent, and below that part of the deepest patch's, bears
/// nothing: rounding has left it between faces that are flush. Test:
/// FlushBricks.ThatStandExactlyOnEachOtherPushUpwards.
inline constexpr double bears_nothing = 1e-8;
inline constexpr double shallow_patch = 1e-3;  ///< see bears_nothing
/// By how much the patch with the last run's normal is preferred as the first, so that the order does not flicker.
inline constexpr double keep_first = 1.05;
/// An overlap that is this many times deeper than its rim is wide, more than any needle, is looked at in other
/// directions too; one of solids of whose rim pieces are missing, if it is deeper than wide at all.
/// Test: Pair.ALumpAtACornerOfFlushBricksIsNotPushedFromEndToEnd, PartOfARim.OfCrumbsOnAWallIsNotPushedFromEndToEnd.
inline constexpr double lump_depth = 1000.0;
/// Depth of a contact, as a part of the smaller body's size, that is believed where no run has measured any: a solver
/// then holds up what rests on it, and a wrong direction moves a body by no more than this in a few steps.
/// Test: StarvedCrate.DoesNotSinkIn, StarvedCrate.IsNeverThrown.
inline constexpr double unmeasured_depth = 1e-4;
/// Of the smaller body's size: by so much a place of contact that was guessed may part sideways before it is
/// forgotten, and so near to each other two are one. Test: HastyMemory.AddsThePlacesOfRunsBefore.
inline constexpr double hasty_slack = 2e-3;
inline constexpr double hasty_spacing = 0.02;
/// Of the smaller body's size: overlaps of two triangles below it say nothing of which way they part. Faces that are
/// flush overlap by nothing along each other's normals, but neither is a way out. Test:
/// Vote.OfFlushFacesIsWhatIsExpected.
inline constexpr double hasty_alike = 0.003;
/// Of the smaller body's size: by how much a contact that is guessed may be deeper than the one guessed before it,
/// while bodies sink in, and how deep it may become. Starved gears pass through each other without; bolts shake with
/// three times the first, or with all of the second at once (`odds_ode_scenes --only gears --ours --counted 280
/// --budgets 5,10`). Test: GuessedDepth.RisesWhileBodiesSinkIn.
inline constexpr double hasty_rise = 6e-6;
inline constexpr double hasty_deepest = 2e-3;  ///< see hasty_rise
/// Of the smaller body's size: bodies meet in one part of them where their places of contact are spread (PlaceSpread)
/// by no more than this. Of gears that is .06 to .1, of a bolt in its nut .16 to .19. Test:
/// PlaceSpread.TellsGearsFromABoltInItsNut.
inline constexpr double one_place = 0.13;
/// Of the smaller body's size: centres no farther from each other have no direction that one could go by. Test:
/// PlaceSpread.IsOfWhatStandsStillBetweenTwoCentres.
inline constexpr double hasty_line = 0.1;
/// Cosine between the normals of two contacts that may be the same one: 30 degrees.
/// Test: LateManifold.ASuccessorGivesWhatItsPredecessorGave.
inline constexpr double hasty_agreement = 0.87;
/// Cosine (75 degrees) below which the normals where two triangles cross are across a direction in which the bodies
/// part: it is another place of contact. Test: GuessedContacts.OfTheOppositeSideDoNotPushIntoIt.
inline constexpr double hasty_across = 0.25;
/// Cosine (45 degrees) above which they are along it; and between the two, how many times as far as in a direction of
/// their own the triangles have to go in it to part, for the crossing to be another place: starved gears jam without
/// (`odds_ode_scenes --only gears --ours --counted 280 --budgets 10,20`), with 10 of them more than with 1.5 or 3, and
/// starved bolts, which slip and are thrown about where what is along it begins at 75 degrees.
/// Test: GuessedContacts.OfAnotherPlaceHaveADirectionOfTheirOwn.
inline constexpr double hasty_along = 0.7;
inline constexpr double hasty_elsewhere = 1.5;  ///< see hasty_along
/// How many times what is believed of a depth from motion, or need not be measured, a run may say that has looked at as
/// many pairs as are kept: they may be taken for one lump, but runs at one pose must come to what they find there.
/// Tests: BoltInItsNut.IsHeldByAsMuchAsItIsDeep, BoltInItsNut.ExactRunsForgetThePoseBefore.
inline constexpr double sampled_depth = 2.0;
/// Of the smaller body's size: what has moved farther since its depth was known last is elsewhere, and its depth there
/// is what a run finds. Test: BoltInItsNut.ExactRunsForgetThePoseBefore.
inline constexpr double coherent_motion = 0.05;
/// A mesh within a solid leaves it the way it came in, unless another way is shorter than this part of that one: one
/// that has fallen half through a floor goes up all the same. Test: MeshWithinASolid.GoesBackTheWayItCame.
inline constexpr double way_it_came = 0.25;
/// Of the smaller body's size: bodies in ODE that have moved by less keep their contacts (Request::carry_motion).
/// Stacks drifted as little with it as without, and ten times as far with 1e-4. Test: Bricks.CreepingAddsUp.
inline constexpr double resting_motion = 1e-5;
/// Of the smaller body's size: contacts that are late (Request::late_contacts) are carried along while bodies move
/// by less, and turn against each other by less than late_turn, radians: carried over ten times that, turns of a thread
/// pushed a bolt that had left them. Tests: LateManifold.FollowsTheBodies, LateManifold.EndsWhereBodiesTurn.
inline constexpr double slid_motion = 0.16;
/// See slid_motion. From there on known directions also stay with the larger body, on which a small one turns; of what
/// turns more slowly they are seen anew. Test: SheetInAHurry.ABallThatTurnsKnowsItsSideInEitherOrder.
inline constexpr double late_turn = 0.02;
/// Radians a run: bodies that turn by more against each other do not slide. Test: LateManifold.GivesTheShareOfARun.
inline constexpr double late_turning = 1e-3;
/// Of the smaller body's size: a late contact that has slid by more than the first is measured anew; by more than the
/// second, it is not looked for. Test: LateManifold.MeasuresWhatSlides.
inline constexpr double slid_measured = 2.5e-3;
inline constexpr double slid_slip = 0.08;  ///< see slid_measured
/// Of what a contact has slid, how far off its surface it is looked for. Test: SlidContacts.TurnWithTheSurface.
inline constexpr double slid_bend = 0.2;
/// Cosine (10 degrees) from which a normal of a contact is that of its facet, and turns with the surface.
/// Test: SlidContacts.TurnWithTheSurface.
inline constexpr double slid_facet = 0.985;
/// Of the smaller body's size: a late contact that has come apart by no more is kept for when it touches again; and
/// across its normal. With 2e-2 and 1e-2 an edge that rocks by two degrees is found again without a patch, but bodies
/// that land are held in the wrong places: of 528 starved stacks (`odds_ode_scenes --only stacks --ours --budgets 5,7`,
/// 3 to 10 bricks) 6 fell, none with these. Test: LateManifold.ForgetsWhatHasGone.
inline constexpr double late_gap = 5e-3;
inline constexpr double late_slip = 5e-3;
/// The same: late contacts of a short budget, or of bodies that slide, are those of bodies that are pressed together by
/// this: what is about to touch while a question is being answered is among them.
/// Test: ShortBudget.KnowsWhatIsAboutToTouch.
inline constexpr double late_press = 1e-3;
/// The same, a run: bodies that move by more where they touch slide. Test: ShortBudget.KnowsWhatIsAboutToTouch.
inline constexpr double late_still = 2e-4;
/// The same: contacts nearer to each other are one. Test: LateManifold.ASuccessorGivesWhatItsPredecessorGave.
inline constexpr double late_spacing = 0.05;
/// Of the smaller body's size: of a late contact's depth so much is given at once, or its share of the runs in which it
/// came. Tests: LateManifold.PushesGently, LateManifold.GivesTheShareOfARun.
inline constexpr double late_least = 3e-5;
/// The same, a run: how fast the rest is given, and so how fast at most it pushes bodies apart. What they lost when
/// they sank in they win back then, and a stack that rocks wins more each time: with three times both 4 of 192 such
/// stacks fell. Tests: LateManifold.PushesGently, LateManifold.GivesADepthNoFasterThanItsRate,
/// LateManifold.PushesApartNoFasterThanItsRate.
inline constexpr double late_rise = 6e-6;
/// Of a mesh's size: corners so near to a plane lie in it, whatever single precision made of them.
/// Test: FlatFaces.OfABoxAreSixHoweverItIsCut.
inline constexpr double flat_face = 1e-6;
/// Cosine (2.6 degrees) from which two flat faces lie on each other, and how deep at most, as a part of the smaller
/// body's size: what is deeper came in elsewhere. Tests: FlushContacts.EndWhereTheFacesTilt,
/// FlushContacts.OfFacesOnFarSidesAreNone.
inline constexpr double flush_faces = 0.999;
inline constexpr double flush_depth = 0.02;  ///< see flush_faces
/// Cosine (26 degrees) and gap, as a part of the smaller body's size, to which faces that lay on each other are kept in
/// mind: a crate that hops or is tripped comes down on an edge of the face that it stood on. Tests:
/// LeaningFaces.AreKeptInMindUntilTheyTilt, FlushContacts.AHopIsNotForgotten.
inline constexpr double leaning_faces = 0.9;
inline constexpr double leaning_gap = 0.1;  ///< see leaning_faces
/// Of a hit where such faces overlap, in a run without a proof. Test:
/// FlushPair.OfARunWithoutAProofAreGivenAllTheSame.
inline constexpr double flush_probability = 0.99;
/// Cosine below which a surface is a wall, whose slope tells nothing of where an overlap gets deeper.
inline constexpr double steep = 0.05;
/// An overlap whose depth is below this part of its reach is flat: it is not one of a spike.
/// Test: LeaningSpikes.AreAsDeepAsTheirTips.
inline constexpr double flat_overlap = 0.05;
/// How far inside of a spike's surface the next place is looked for, as a part of the step.
inline constexpr double inside_surface = 1e-3;  ///< see flat_overlap
/// What is less deep than this part of its whole rim's size is within the rim. Tests:
/// RoomsOfOneMesh.KeepCratesInTheirCorners, LeaningSpikes.AreAsDeepAsTheirTips.
inline constexpr double flat_within_rim = 0.02;
/// An overlap that is nowhere deeper by more than this part of itself is level: more rays would cost time and hardly
/// move a force. Test: SummitsOfConvex.BodiesAreFound.
inline constexpr double level_overlap = 0.001;
/// A shorter step towards where the last one led out of an overlap is worth its rays if this part of the depth may be
/// gained on it. Test: SummitsOfPlates.AreFoundWithFewRays.
inline constexpr double worth_a_step = 0.02;
/// What is deeper than the deepest place that was known by more than this part of it is another place, and not the
/// next corner of the same facets. Test: ContactPatch.SphereOnPlaneHasOneDeepContact.
inline constexpr double another_summit = 0.01;
/// Contacts of a patch nearer to each other than this part of the depth, or of the lever arm, are one.
inline constexpr double spacing_by_depth = 0.5;
inline constexpr double spacing_by_lever = 1e-3;  ///< see spacing_by_depth
/// Contacts of two patches of one direction nearer to each other than this part of the depth are one.
/// Test: TwoRimsOfOneOverlap.GiveEachContactOnce.
inline constexpr double same_contact = 0.05;

/// Contacts of two runs that lie nearer to each other than this part of the smaller body's size, and whose normals'
/// cosine is above same_contact_side, are one; a surface at a greater slant is not what a contact was with.
/// Test: NearBricks.WhatMeetsIsTheSameWithAMarginAsWithout, NearContacts.ABallThatTurnedAwayIsNotNear.
inline constexpr double same_contact_place = 0.02;
inline constexpr double same_contact_side = 0.5;  ///< see same_contact_place

/// A half extent of a node below this part of the largest counts as this part when cells are counted; no unit. Thinner
/// cells would be filled or empty by the rounding of corners (1e-7 in floats).
/// Test: WellFilledCells.FlatBoxKeepsItsSurfaceInOneLayerDespiteRounding.
inline constexpr double thinnest_extent = 1e-4;
/// A cell still counts as well filled if this part of the area is missing; no unit. Sums of clipped areas err by about
/// 1e-12. Test: WellFilledCells.DiagonalSectionFillsItsCellsExactly.
inline constexpr double cell_fill_slack = 1e-9;

}  // namespace odds::tolerances
