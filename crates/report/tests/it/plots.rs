//! Plots: what is drawn, what is left out, and that any data give a drawing.

use std::path::Path;

use albatross_report::ReportError;
use albatross_report::plot::{
    Axis, BodeChannel, BodeCurve, BodePlot, LegendPlace, LinePlot, Panel, PhaseDisplay, Scale, ScatterPlot,
    Series, Style,
};
use proptest::prelude::*;

use crate::svg_check::{apart, assert_well_formed, groups, path_points, texts};

fn time() -> Axis {
    Axis::new("Time", "s")
}

fn one_curve(x: &[f64], y: &[f64]) -> LinePlot {
    LinePlot::new("T", time()).with(Panel::new("y", "m").with(Series::new("curve", Style::model(0), x, y)))
}

/// Columns of a reference time history by name.
fn reference(names: [&str; 5]) -> [Vec<f64>; 5] {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../fixtures/f25-like/reference/doublet_0p5Hz.csv"
    );
    let text = std::fs::read_to_string(Path::new(path)).unwrap();
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|f| f.parse().unwrap()).collect())
        .collect();
    names.map(|name| {
        let column = header.iter().position(|field| *field == name).unwrap();
        rows.iter().map(|row| row[column]).collect()
    })
}

fn time_histories() -> LinePlot {
    let [t, elevator, alpha, q, nz] = reference(["t_s", "elevator_deg", "alpha_deg", "q_deg_s", "nz"]);
    let panel = |label: &str, unit: &str, y: &[f64]| {
        let scaled: Vec<f64> = y.iter().map(|y| 1.1 * y).collect();
        Panel::new(label, unit)
            .with(Series::new("Reference", Style::reference(), &*t, y))
            .with(Series::new("Albatross", Style::model(0), &*t, scaled))
    };
    LinePlot::new("0.5 Hz doublet", time())
        .with(panel("Elevator", "deg", &elevator))
        .with(panel("α", "deg", &alpha))
        .with(panel("q", "deg/s", &q))
        .with(panel("n_{z}", "", &nz))
}

#[test]
fn four_stacked_panels_share_abscissa_and_legend() {
    let svg = time_histories().render().unwrap().markup;
    assert_well_formed(&svg);
    let series = groups(&svg, "series");
    assert_eq!(series.len(), 8);
    assert!(series.iter().all(|group| group.matches("<path").count() == 1));
    let texts = texts(&svg, "text");
    assert_eq!(texts.iter().filter(|text| *text == "Reference").count(), 1);
    assert_eq!(texts.iter().filter(|text| *text == "Time (s)").count(), 1);
    assert!(texts.iter().any(|text| text == "nz"), "lowered z: {texts:?}");
    // Eight curves of 10 001 points.
    assert!(svg.len() < 120_000, "{}", svg.len());
}

#[test]
fn equal_input_gives_equal_bytes() {
    assert_eq!(
        time_histories().render().unwrap(),
        time_histories().render().unwrap()
    );
}

#[test]
fn title_and_description_speak_for_the_plot() {
    let svg = time_histories()
        .described("Reference & model.")
        .render()
        .unwrap()
        .markup;
    assert_eq!(texts(&svg, "title"), ["0.5 Hz doublet"]);
    assert_eq!(
        texts(&svg, "desc"),
        [
            "Reference &amp; model. Elevator (deg); α (deg); q (deg/s); n_z over Time (s). Series: Reference; Albatross."
        ]
    );
    assert!(svg.contains("role=\"img\""));
}

#[test]
fn text_is_escaped_wherever_it_comes_from() {
    let evil = "<b> & \"quoted\" 'x'";
    let x = [0.0, 1.0];
    let plot = LinePlot::new(evil, Axis::new(evil, evil)).described(evil).with(
        Panel::new(evil, evil)
            .with_guide_x(0.5, evil)
            .with(Series::new(evil, Style::model(0), x, x).with_labels([evil, "\u{0}\u{7}"])),
    );
    let svg = plot.render().unwrap().markup;
    assert_well_formed(&svg);
    assert!(!svg.contains("<b>"));
    assert_eq!(texts(&svg, "title"), ["&lt;b&gt; &amp; &quot;quoted&quot; 'x'"]);
}

#[test]
fn the_label_of_a_guide_stands_where_no_curve_passes() {
    let height = |level: f64| {
        let mut plot = one_curve(&[0.0, 1.0], &[level, level]);
        let panel = plot.panels.remove(0).with_guide_x(0.5, "paper");
        plot.panels.push(panel);
        plot.panels[0].y = Axis::new("y", "").with_limits(0.0, 1.0);
        let svg = plot.render().unwrap().markup;
        let before = svg.split(">paper<").next().unwrap();
        let label = before.rsplit("<text").next().unwrap();
        let y = label.split(" y=\"").nth(1).unwrap().split('"').next().unwrap();
        y.parse::<f64>().unwrap()
    };
    // Top and bottom of the frame: pixels grow downwards.
    let (over_a_low_curve, under_a_high_one) = (height(0.03), height(0.97));
    assert!(over_a_low_curve + 50.0 < under_a_high_one);
    assert_eq!(height(0.5), over_a_low_curve, "at the top if nothing is there");
}

#[test]
fn val_a_peak_of_one_sample_is_drawn_where_it_is() {
    let x: Vec<f64> = (0..10_000).map(|i| 1e-3 * f64::from(i)).collect();
    let mut y: Vec<f64> = x.iter().map(|x| (20.0 * x).sin()).collect();
    y[5_000] = 4.0;
    let mut plot = one_curve(&x, &y);
    plot.panels[0].y = Axis::new("y", "").with_limits(-4.0, 4.0);
    plot.x = time().with_limits(0.0, 10.0);
    let svg = plot.render().unwrap().markup;
    let points = path_points(groups(&svg, "series")[0]);
    let top = points.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    let (left, right) = (points[0].0, points.last().unwrap().0);
    // 5 s of 9.999 s; half a pixel for the column, coordinates to 0.01.
    assert!(
        (top.0 - left - (right - left) * 5.0 / 9.999).abs() < 0.02,
        "{top:?} between {left} and {right}"
    );
    // At the limit 4 the curve touches the top of the frame: above every other point.
    assert!(points.iter().filter(|point| point.1 < top.1 + 1.0).count() == 1);
}

#[test]
fn ten_thousand_points_of_noise_stay_small() {
    let mut state = 1_u64;
    let mut noise = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let y: Vec<f64> = (0..10_000).map(|_| noise()).collect();
    let x: Vec<f64> = (0..10_000).map(f64::from).collect();
    let svg = one_curve(&x, &y).render().unwrap().markup;
    assert!(svg.len() < 60_000, "{}", svg.len());
    let smooth: Vec<f64> = x.iter().map(|x| (x * 0.003).sin()).collect();
    let svg = one_curve(&x, &smooth).render().unwrap().markup;
    assert!(svg.len() < 12_000, "{}", svg.len());
}

#[test]
fn gaps_break_a_curve_and_a_lone_point_is_a_dot() {
    let svg = one_curve(
        &[0.0, 1.0, 2.0, 3.0, 4.0],
        &[0.0, 1.0, f64::NAN, 2.0, f64::INFINITY],
    )
    .render()
    .unwrap();
    assert_well_formed(&svg.markup);
    let series = groups(&svg.markup, "series")[0];
    assert_eq!(series.matches("<path").count(), 2, "{series}");
    assert!(svg.notes.is_empty());
}

#[test]
fn empty_and_constant_series_are_drawn_for_what_they_are() {
    let empty = one_curve(&[], &[]).render().unwrap().markup;
    assert_well_formed(&empty);
    assert!(texts(&empty, "text").contains(&"no data".to_owned()));
    let constant = one_curve(&[0.0, 1.0], &[232.7, 232.7]).render().unwrap().markup;
    let points = path_points(groups(&constant, "series")[0]);
    assert_eq!(points.len(), 2);
    assert_eq!(points[0].1, points[1].1);
}

#[test]
fn what_a_logarithmic_axis_cannot_show_is_noted() {
    let series = Series::new(
        "level",
        Style::model(0),
        [1.0, 2.0, 3.0, 4.0],
        [1.0, 0.0, -1.0, 100.0],
    );
    let plot = LinePlot::new("T", time()).with(Panel::over(Axis::log("P", "W")).with(series));
    let svg = plot.render().unwrap();
    assert_eq!(
        svg.notes,
        ["2 points of “level” not shown: no place on a logarithmic axis."]
    );
    assert!(texts(&svg.markup, "text").contains(&svg.notes[0]));
    assert!(texts(&svg.markup, "desc")[0].contains("2 points"));
}

fn lag_channel(title: &str) -> BodeChannel {
    let w: Vec<f64> = (0..=120)
        .map(|i| 10f64.powf(-3.0 + 0.05 * f64::from(i)))
        .collect();
    let db: Vec<f64> = w.iter().map(|w| -10.0 * (1.0 + w * w).log10()).collect();
    let deg: Vec<f64> = w.iter().map(|w| -w.atan().to_degrees()).collect();
    let turned: Vec<f64> = deg.iter().map(|deg| deg + 720.0).collect();
    BodeChannel::new(title)
        .with(BodeCurve::new("one", Style::reference(), &*w, &*db, deg))
        .with(BodeCurve::new("two", Style::model(0), w, db, turned))
}

#[test]
fn a_bode_grid_has_decades_as_powers_and_whole_turns_taken_out() {
    let plot = (0..4).fold(BodePlot::new("B", Axis::log("Frequency", "rad/s")), |plot, i| {
        plot.with(lag_channel(&format!("channel {i}")))
    });
    let svg = plot.render().unwrap().markup;
    assert_well_formed(&svg);
    let series = groups(&svg, "series");
    assert_eq!(series.len(), 16);
    // Thinning may keep other points of the same curve: twice its tolerance, and rounding.
    // In each phase panel both systems lie on top of each other although given two turns apart.
    assert!(apart(&path_points(series[2]), &path_points(series[3])) < 0.12);
    assert!(
        svg.contains(">−3</tspan>") && svg.contains(">3</tspan>"),
        "10^-3 to 10^3"
    );
    let texts = texts(&svg, "text");
    assert_eq!(texts.iter().filter(|text| *text == "−45").count(), 4);
    assert_eq!(
        texts.iter().filter(|text| *text == "one").count(),
        1,
        "one legend for all channels"
    );
}

#[test]
fn a_phase_may_be_shown_as_given_or_folded() {
    let mut plot = BodePlot::new("B", Axis::log("Frequency", "Hz")).with(lag_channel(""));
    plot.phase = PhaseDisplay::AsGiven;
    let as_given = plot.render().unwrap().markup;
    assert!(texts(&as_given, "text").contains(&"720".to_owned()));
    plot.phase = PhaseDisplay::Wrapped;
    let folded = plot.render().unwrap().markup;
    let series = groups(&folded, "series");
    assert!(apart(&path_points(series[2]), &path_points(series[3])) < 0.12);
}

#[test]
fn val_rays_of_damping_have_the_slope_of_their_ratio() {
    let mut plot = ScatterPlot::pole_map("P", "rad/s").with_damping_rays([0.6]);
    (plot.x, plot.y) = (plot.x.with_limits(-10.0, 0.0), plot.y.with_limits(0.0, 10.0));
    let svg = plot.render().unwrap().markup;
    assert_well_formed(&svg);
    let ray = svg
        .split("<line ")
        .find(|line| line.contains("stroke-dasharray=\"1 2.5\""))
        .unwrap();
    let at = |name: &str| -> f64 {
        ray.split(&format!("{name}=\""))
            .nth(1)
            .unwrap()
            .split('"')
            .next()
            .unwrap()
            .parse()
            .unwrap()
    };
    let frame = svg.split("<rect x=").nth(1).unwrap();
    let size = |name: &str| -> f64 {
        frame
            .split(&format!("{name}=\""))
            .nth(1)
            .unwrap()
            .split('"')
            .next()
            .unwrap()
            .parse()
            .unwrap()
    };
    let (re, im) = (
        (at("x1") - at("x2")) / size("width"),
        (at("y1") - at("y2")) / size("height"),
    );
    // cos of the angle from the negative real axis is the damping ratio: 0.6 over 0.8.
    assert!((re / im - 0.75).abs() < 1e-3, "{re} {im}");
    assert!(texts(&svg, "text").contains(&"ζ = 0.6".to_owned()));
}

#[test]
fn contradictions_are_refused_with_a_cure() {
    let no_panels = LinePlot::new("empty", time()).render().unwrap_err();
    assert!(matches!(no_panels, ReportError::NoPanels { .. }));
    let lengths = one_curve(&[0.0, 1.0], &[0.0]).render().unwrap_err();
    assert_eq!(
        lengths.to_string(),
        "series `curve`: 2 abscissae but 1 ordinates (y); the lists must have one length"
    );
    let mut narrow = one_curve(&[0.0], &[0.0]);
    narrow.width = f64::NAN;
    assert!(matches!(
        narrow.render().unwrap_err(),
        ReportError::Size { what: "width", .. }
    ));
    let mut limits = one_curve(&[0.0], &[0.0]);
    limits.x = Axis::log("f", "Hz").with_limits(0.0, 1.0);
    assert_eq!(
        limits.render().unwrap_err().to_string(),
        "axis `f`: limits 0 to 1 do not span an interval; they must be finite and increasing, and positive on a \
         logarithmic axis"
    );
}

#[test]
fn long_names_widen_nothing_and_overlap_nothing() {
    let long =
        "a name that goes on and on until no legend could ever hold it in a single line of the plot, ever";
    let mut plot = one_curve(&[0.0, 1.0], &[0.0, 1.0]);
    plot.panels[0].series[0].name = long.to_owned();
    plot.width = 400.0;
    let svg = plot.render().unwrap().markup;
    assert_well_formed(&svg);
    assert!(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"400\""));
    assert!(!texts(&svg, "text").contains(&long.to_owned()), "wrapped");
    plot.legend = LegendPlace::Hidden;
    assert!(groups(&plot.render().unwrap().markup, "legend").is_empty());
}

fn any_values() -> impl Strategy<Value = Vec<f64>> {
    let value = prop_oneof![
        4 => proptest::num::f64::ANY,
        4 => -10.0..10.0f64,
        1 => Just(0.0),
        1 => Just(f64::NAN),
    ];
    proptest::collection::vec(value, 0..40)
}

fn any_scale() -> impl Strategy<Value = Scale> {
    prop_oneof![
        Just(Scale::Linear),
        Just(Scale::Log),
        Just(Scale::Degrees),
        Just(Scale::Decibels)
    ]
}

proptest! {
    #[test]
    fn prop_any_data_give_a_well_formed_drawing(
        x in any_values(), y in any_values(), x_scale in any_scale(), y_scale in any_scale(),
        text in "\\PC{0,30}", width in 200.0..1200.0f64, markers: bool,
    ) {
        let count = x.len().min(y.len());
        let style = if markers { Style::points(1) } else { Style::model(3) };
        let labels = vec![text.clone(); count];
        let series = Series::new(&*text, style, &x[..count], &y[..count]).with_labels(labels);
        let panel = Panel::over(Axis::new(&*text, &*text).with_scale(y_scale)).with(series.clone());
        let mut plot = LinePlot::new(&*text, Axis::new(&*text, "").with_scale(x_scale)).with(panel.clone()).with(panel);
        plot.width = width;
        let svg = plot.render().unwrap();
        // The text may itself contain such words; look at the drawing without it.
        if !text.contains("--") && !text.contains("inf") && !text.contains("NaN") {
            assert_well_formed(&svg.markup);
        }
        let mut map = ScatterPlot::pole_map(&*text, "rad/s").with(series).with_damping_rays([0.1, 1.0, f64::NAN]);
        map.width = width;
        prop_assert!(map.render().is_ok());
    }

    #[test]
    fn prop_curves_stay_inside_the_picture(
        points in proptest::collection::vec((-1e3..1e3f64, -1e3..1e3f64), 2..60), low in -900.0..0.0f64, span in 1.0..900.0f64,
    ) {
        let (x, y): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
        let mut plot = one_curve(&x, &y);
        plot.x = time().with_limits(low, low + span);
        plot.panels[0].y = Axis::new("y", "").with_limits(low, low + span);
        let svg = plot.render().unwrap().markup;
        for (x, y) in path_points(groups(&svg, "series")[0]) {
            prop_assert!((0.0..=800.0).contains(&x) && (0.0..=460.0).contains(&y), "{} {}", x, y);
        }
    }
}
